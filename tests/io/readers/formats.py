# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Readers written from the formats' specifications, sharing nothing with the writers."""

import struct
import zlib

import numpy as np


def lzf_decompress(data, size):
    """LZF: a control byte below 32 starts a run of literals, others a copy from earlier output."""
    out = bytearray()
    i = 0
    while i < len(data):
        control = data[i]
        i += 1
        if control < 32:
            out += data[i : i + control + 1]
            i += control + 1
            continue
        length = control >> 5
        if length == 7:
            length += data[i]
            i += 1
        start = len(out) - ((control & 31) << 8) - data[i] - 1
        i += 1
        run = out[start : start + length + 2]  # shorter where the copy overlaps itself, and then repeated
        out += (run * ((length + 1) // len(run) + 1))[: length + 2]
    assert len(out) == size, (len(out), size)
    return bytes(out)


def read_pcd(path):
    """(header, structured array) of a PCD file of version 0.7."""
    data = path.read_bytes()
    header, offset = {}, 0
    while "DATA" not in header:
        end = data.index(b"\n", offset)
        line = data[offset:end].decode("ascii")
        offset = end + 1
        if not line.startswith("#"):
            key, *words = line.split(" ")
            header[key] = words
    kinds = {"F": "f", "U": "u", "I": "i"}
    assert set(header["COUNT"]) == {"1"}
    dtype = np.dtype(
        [(n, "<" + kinds[t] + s) for n, t, s in zip(header["FIELDS"], header["TYPE"], header["SIZE"])]
    )
    count = int(header["POINTS"][0])
    assert count == int(header["WIDTH"][0]) * int(header["HEIGHT"][0])
    body = data[offset:]
    encoding = header["DATA"][0]
    if encoding == "binary":
        assert len(body) == count * dtype.itemsize
        return header, np.frombuffer(body, dtype)
    if encoding == "ascii":
        return header, text_table(body.decode("ascii").splitlines(), dtype, " ")
    packed, raw = struct.unpack("<II", body[:8])
    assert len(body) == 8 + packed and raw == count * dtype.itemsize
    plain = lzf_decompress(body[8:], raw)
    points, at = np.empty(count, dtype), 0
    for name in dtype.names:
        points[name] = np.frombuffer(plain, dtype[name], count, at)
        at += dtype[name].itemsize * count
    return header, points


def text_table(lines, dtype, separator):
    points = np.empty(len(lines), dtype)
    rows = [line.split(separator) for line in lines]
    assert all(len(words) == len(dtype) for words in rows)
    for name, words in zip(dtype.names, zip(*rows)):
        points[name] = list(map(float if dtype[name].kind == "f" else int, words))
    return points


def read_ply(path):
    """(obj_info, structured array) of a PLY file with vertices only."""
    data = path.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    types = {"float": "<f4", "double": "<f8", "uchar": "u1", "ushort": "<u2", "uint": "<u4"}
    fields, info, count = [], {}, None
    lines = head.decode("ascii").splitlines()
    assert lines[0] == "ply"
    for words in (line.split() for line in lines):
        if words[0] == "element":
            assert words[1] == "vertex" and count is None
            count = int(words[2])
        elif words[0] == "property":
            fields.append((words[2], types[words[1]]))
        elif words[0] == "obj_info":
            info[words[1]] = int(words[2])
    dtype = np.dtype(fields)
    if lines[1] == "format ascii 1.0":
        points = text_table(body.decode("ascii").splitlines(), dtype, " ")
    else:
        assert lines[1] == "format binary_little_endian 1.0"
        points = np.frombuffer(body, dtype)
    assert len(points) == count
    return info, points


def unfilter(kind, line, above, step):
    """PNG specification, section 9: filtering."""
    out = bytearray(line)
    for i in range(len(out)):
        a = out[i - step] if i >= step else 0
        b = above[i]
        c = above[i - step] if i >= step else 0
        if kind == 4:
            p = a + b - c
            distance = [abs(p - a), abs(p - b), abs(p - c)]
            guess = (a, b, c)[distance.index(min(distance))]
        else:
            guess = (0, a, b, (a + b) // 2)[kind]
        out[i] = (out[i] + guess) & 255
    return bytes(out)


def read_png(path):
    """(pixels rows x cols x channels, texts) of a non-interlaced grey, rgb or rgba PNG."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed, texts = 8, b"", {}
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + size]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + size : at + 12 + size])[0]
        at += 12 + size
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            assert interlaced == 0
        elif kind == b"IDAT":
            packed += body
        elif kind == b"tEXt":
            key, value = body.split(b"\0")
            texts[key.decode()] = value.decode("latin-1")
    channels = {0: 1, 2: 3, 6: 4}[colour]
    step = channels * depth // 8
    plain = zlib.decompress(packed)
    above, rows = bytes(width * step), []
    for row in range(height):
        start = row * (width * step + 1)
        above = unfilter(plain[start], plain[start + 1 : start + 1 + width * step], above, step)
        rows.append(above)
    pixels = np.frombuffer(b"".join(rows), ">u2" if depth == 16 else "u1")
    return pixels.reshape(height, width, channels), texts
