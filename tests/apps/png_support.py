# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Grey PNG images without a library."""

import struct
import zlib
from pathlib import Path

from cli_support import CliTest


def grey_png(rows, bits=16):
    """A grey PNG of these rows of numbers."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), bits, 0, 0, 0, 0)
    lines = b"".join(b"\0" + struct.pack(f">{len(row)}{'H' if bits == 16 else 'B'}", *row) for row in rows)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b"")


class PngTest(CliTest):
    def store(self, name, rows, bits=16):
        Path(self.folder, name).write_bytes(grey_png(rows, bits))

    def grey_rows(self, name):
        """The numbers of a grey PNG of 8 or 16 bits, row by row, by undoing its filters."""
        data, place, idat = self.bytes_of(name), 8, b""
        while place < len(data):
            size, kind = struct.unpack_from(">I4s", data, place)
            if kind == b"IHDR":
                width, height, bits = struct.unpack_from(">IIB", data, place + 8)
            if kind == b"IDAT":
                idat += data[place + 8:place + 8 + size]
            place += size + 12
        step = bits // 8
        size = step * width
        raw, before, rows = zlib.decompress(idat), bytes(size), []
        for y in range(height):
            kind, line = raw[y * (size + 1)], bytearray(raw[y * (size + 1) + 1:(y + 1) * (size + 1)])
            for i in range(size):
                left, up, corner = (line[i - step] if i >= step else 0), before[i], (before[i - step] if i >= step else 0)
                nearest = min((abs(up - corner), 0, left), (abs(left - corner), 1, up), (abs(left + up - 2 * corner), 2, corner))
                line[i] = (line[i] + (0, left, up, (left + up) // 2, nearest[2])[kind]) & 255
            rows.append(list(struct.unpack(f">{width}{'H' if bits == 16 else 'B'}", line)))
            before = line
        return rows
