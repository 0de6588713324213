#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar depth stereo: files, the trace of a pixel, errors."""

import os
import struct
import unittest
import zlib
from pathlib import Path

from cli_support import CliTest

SAMPLE = ("depth", "stereo", "builtin:dots", "--disparities", "64")


def png(width, height, rows, colour=0, bits=8):
    """A PNG; `rows` are the bytes of all rows."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    size = len(rows) // height
    filtered = b"".join(b"\0" + rows[y * size:(y + 1) * size] for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(filtered)) + chunk(b"IEND", b"")


def noise(width, height):
    state, levels = 1, bytearray()
    for _ in range(width * height):
        state = (1103515245 * state + 12345) % 2**31
        levels.append(state >> 16 & 0xFF)
    return bytes(levels)


class StereoCommand(CliTest):
    def store(self, name, data):
        Path(self.folder, name).write_bytes(data)

    def test_writes_every_quantity_as_arrays_and_images(self):
        outputs = [name + suffix for name in ("depth", "disparity", "wall_status") for suffix in (".npy", ".png")]
        arguments = [word for name in outputs for word in ("-o", name)]
        done = self.succeed(*SAMPLE, "--focal-length-px", "430", "--baseline-mm", "50", *arguments)
        self.assertRegex(done.stdout, r"^320x200 pixels: \d+\.\d % valid, ")
        disparity = self.bytes_of("disparity.npy")
        self.assertEqual(len(disparity), len(self.bytes_of("depth.npy")))
        center = len(disparity) - 4 * 320 * 200 + 4 * (90 * 320 + 190)
        self.assertEqual(round(struct.unpack_from("<f", disparity, center)[0]), 36)
        self.assertAlmostEqual(struct.unpack_from("<f", self.bytes_of("depth.npy"), center)[0], 21.5 / 36, delta=0.002)
        for name in outputs:
            self.assertTrue(self.bytes_of(name).startswith(b"\x89PNG" if name.endswith("png") else b"\x93NUMPY"), name)

    def test_reads_png_images_of_any_grey_kind(self):
        levels = noise(90, 20)
        shifted = b"".join(levels[y * 90 + 9:y * 90 + 90] + levels[y * 90:y * 90 + 9] for y in range(20))
        kinds = {"grey": (lambda b: b, 0, 8), "rgb": (lambda b: bytes(v for v in b for _ in range(3)), 2, 8),
                 "wide": (lambda b: bytes(v for v in b for _ in range(2)), 0, 16)}
        results = []
        for name, (convert, colour, bits) in kinds.items():
            self.store("l.png", png(90, 20, convert(levels), colour, bits))
            self.store("r.png", png(90, 20, convert(shifted), colour, bits))
            self.succeed("depth", "stereo", "l.png", "r.png", "--disparities", "24", "-o", f"{name}_disparity.npy")
            results.append(self.bytes_of(f"{name}_disparity.npy"))
        self.assertEqual(results[0], results[1])
        self.assertEqual(results[0], results[2])
        self.assertEqual(round(struct.unpack_from("<f", results[0], len(results[0]) - 4 * (90 * 10 - 50))[0]), 9)

    def test_explains_a_pixel(self):
        text = self.succeed(*SAMPLE, "--explain", "190,90").stdout
        self.assertIn("pixel 190,90: valid\ndisparity 36", text)
        self.assertRegex(text, r"(?m)^ +36 +0 +\d+  winner$")
        self.assertEqual(text.count("  passed  "), 6)

    def test_threads_and_instruction_sets_do_not_change_the_bytes(self):
        self.succeed(*SAMPLE, "--threads", "1", "-o", "a_disparity.npy")
        self.environment["GLIDAR_ISA"] = "baseline"
        self.succeed(*SAMPLE, "--threads", "3", "-o", "b_disparity.npy")
        self.assertEqual(self.bytes_of("a_disparity.npy"), self.bytes_of("b_disparity.npy"))

    def expect_error(self, message, *arguments):
        done = self.run_program("depth", "stereo", *arguments)
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn(message, done.stderr)
        self.assertFalse([name for name in os.listdir(self.folder) if name.startswith(("disparity", "depth"))])

    def test_bad_images_are_errors(self):
        grey = png(90, 20, noise(90, 20))
        self.store("good.png", grey)
        self.store("small.png", png(80, 20, noise(80, 20)))
        self.store("cut.png", grey[:300])
        self.store("text.png", b"no image")
        self.store("empty.png", b"")
        self.store("colour.png", png(90, 20, noise(90, 60), 2))
        output = ("-o", "disparity.npy", "--disparities", "16")
        self.expect_error("right image: has 80x20 pixels, the left one 90x20", "good.png", "small.png", *output)
        self.expect_error("cut.png: it is damaged", "good.png", "cut.png", *output)
        self.expect_error("text.png: it is not a PNG image", "text.png", "good.png", *output)
        self.expect_error("empty.png: it is not a PNG image", "empty.png", "good.png", *output)
        self.expect_error("colour.png: pixel 0,0 is coloured", "colour.png", "good.png", *output)
        self.expect_error("missing.png", "missing.png", "good.png", *output)
        self.expect_error("RIGHT: there is no right image", "good.png", *output)

    def test_bad_options_are_errors(self):
        pair, output = ("builtin:dots", ), ("-o", "disparity.npy")
        self.expect_error("wider than the image", *pair, *output, "--disparities", "400")
        self.expect_error("--box", *pair, *output, "--box", "12")
        self.expect_error("box_px: is even: 4", *pair, *output, "--box", "4")
        self.expect_error("--p1", *pair, *output, "--p1", "nan")
        self.expect_error("p2: is below p1", *pair, *output, "--p2", "1")
        self.expect_error("depth needs the geometry", *pair, "-o", "depth.png")
        self.expect_error("its name does not state what to write", *pair, "-o", "result.png")
        self.expect_error("neither -o nor --explain", *pair)
        self.expect_error("400,3 is outside the image", *pair, *output, "--explain", "400,3")

    def test_inputs_are_not_overwritten(self):
        data = png(90, 20, noise(90, 20))
        self.store("status.png", data)
        done = self.run_program("depth", "stereo", "status.png", "status.png", "--disparities", "16", "-o", "status.png")
        self.assertEqual(done.returncode, 2)
        self.assertEqual(self.bytes_of("status.png"), data)


if __name__ == "__main__":
    unittest.main()
