# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads the OpenEXR images that glidar_io_files wrote, by the format's specification, and compares every pixel.

usage: exr_reader_test.py PROGRAM
"""

import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

from readers_test import SIZES, expected, np
from skipping import skip

FOLDER = None


def exr_header(data):
    """(attributes as bytes by name, offset behind them) of an OpenEXR file of one part with scan lines."""
    assert struct.unpack("<II", data[:8]) in ((20000630, 2), (20000630, 0x402))  # 0x400: long names
    at, attributes = 8, {}
    while data[at] != 0:
        name, kind, rest = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        (size,) = struct.unpack("<I", data[at : at + 4])
        attributes[name.decode()] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def exr_channels(body):
    """(name, NumPy type) of every channel; the list ends with an empty name."""
    channels = []
    while body[0] != 0:
        name, rest = body.split(b"\0", 1)
        kind, _, x_step, y_step = struct.unpack("<IIII", rest[:16])
        assert (x_step, y_step) == (1, 1)
        channels.append((name.decode(), ("<u4", "<f2", "<f4")[kind]))
        body = rest[16:]
    return channels


def exr_block(packed, size):
    """ZIP compression: zlib, then differences of bytes, then even and odd bytes apart."""
    if len(packed) == size:
        return packed
    steps = np.frombuffer(zlib.decompress(packed), np.uint8).astype(np.int64)
    assert len(steps) == size
    steps[1:] -= 128
    halves = np.cumsum(steps).astype(np.uint8)
    plain = np.empty(size, np.uint8)
    plain[::2], plain[1::2] = halves[: (size + 1) // 2], halves[(size + 1) // 2 :]
    return plain.tobytes()


def read_exr(path):
    """(channels as arrays by name, attributes as bytes) of an OpenEXR image with ZIP compression."""
    data = path.read_bytes()
    attributes, at = exr_header(data)
    assert attributes["compression"] == b"\x03" and attributes["lineOrder"] == b"\x00"
    left, top, right, bottom = struct.unpack("<iiii", attributes["dataWindow"])
    rows, cols = bottom - top + 1, right - left + 1
    channels = exr_channels(attributes["channels"])
    images = {name: np.empty((rows, cols), kind) for name, kind in channels}
    line = np.dtype([(name, kind, cols) for name, kind in channels])
    offsets = struct.unpack(f"<{-(-rows // 16)}Q", data[at : at + 8 * -(-rows // 16)])
    for offset in offsets:
        y, size = struct.unpack("<iI", data[offset : offset + 8])
        count = min(16, rows - y)
        block = exr_block(data[offset + 8 : offset + 8 + size], count * line.itemsize)
        for name, _ in channels:
            images[name][y : y + count] = np.frombuffer(block, line)[name].reshape(count, cols)
    return images, attributes


def channels_of(c):
    """The channels of the fixture's columns."""
    out = {f"P.{k}": c["xyz"][:, n].astype(np.float32) for n, k in enumerate("XYZ")}
    out.update({f"N.{k}": c["normal"][:, n] for n, k in enumerate("XYZ")})
    out.update({k: c["colour"][:, n] for n, k in enumerate("RGB")})
    out.update({k: c[k].astype(np.uint32) for k in ("instance", "ring", "status")})
    return {**out, "Z": c["depth"].astype(np.float32), "intensity": c["intensity"]}


class Exr(unittest.TestCase):
    def test_every_channel_has_the_numbers_of_its_column(self):
        for folder, shape in SIZES.items():
            images, attributes = read_exr(FOLDER / folder / "a.exr")
            wanted = channels_of(expected(folder))
            self.assertEqual(list(images), sorted(wanted))
            for name, values in wanted.items():
                self.assertEqual(images[name].dtype, values.dtype, name)
                np.testing.assert_array_equal(images[name], values.reshape(shape), f"{folder}: {name}")
            self.assertEqual(attributes["displayWindow"], attributes["dataWindow"])
            self.assertTrue(attributes["software"].startswith(b"glidar "), attributes["software"])
            self.assertNotIn("capDate", attributes)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as made:
        FOLDER = pathlib.Path(made)
        subprocess.run([sys.argv[1], made], check=True)
        if not (FOLDER / "small" / "a.exr").exists():
            skip("this build has no OpenEXR", "install libopenexr-dev and build again")
        unittest.main(argv=sys.argv[:1], verbosity=1)
