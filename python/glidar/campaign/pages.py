# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The size of a Parquet file's data by the headers of its pages.

The file's own summary may be wrong: Arrow allocates what each page claims. The headers are structures of Thrift's
compact protocol (thrift-compact-protocol.md of Apache Thrift; parquet.thrift of Apache Parquet, PageHeader).
"""

MAX_HEADER_BYTES = 1 << 16
MAX_LEVELS = 8  # of structures; a page's header has 3
UNCOMPRESSED, COMPRESSED = 2, 3  # fields of PageHeader
TRUE, FALSE, BYTE, I16, I32, I64, DOUBLE, BINARY, LIST, SET, STRUCT = 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12
FIXED_BYTES = {BYTE: 1, DOUBLE: 8}


class _Compact:
    """Reads a structure of the compact protocol. Raises ValueError for other bytes."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def skip(self, count):
        self.at += count
        if self.at > len(self.data):
            raise ValueError("a header that ends early")

    def byte(self):
        self.skip(1)
        return self.data[self.at - 1]

    def varint(self):
        value = shift = 0
        while shift < 70:
            byte = self.byte()
            value |= (byte & 0x7F) << shift
            if byte < 0x80:
                return value
            shift += 7
        raise ValueError("a number of too many bytes")

    def signed(self):
        value = self.varint()
        return (value >> 1) ^ -(value & 1)

    def structure(self, levels=MAX_LEVELS):
        """The integers among its fields, by their numbers; the others are skipped."""
        integers, number = {}, 0
        while head := self.byte():
            number = number + (head >> 4) if head >> 4 else self.signed()
            value = self._value(head & 0xF, levels)
            if value is not None:
                integers[number] = value
        return integers

    def _value(self, kind, levels):
        if kind in (I16, I32, I64):
            return self.signed()
        if not levels:
            raise ValueError("values nested too deeply")
        if kind in FIXED_BYTES:
            self.skip(FIXED_BYTES[kind])
        elif kind == BINARY:
            self.skip(self.varint())
        elif kind in (LIST, SET):
            self._skip_list(levels - 1)
        elif kind == STRUCT:
            self.structure(levels - 1)
        elif kind not in (TRUE, FALSE):
            raise ValueError(f"a field of type {kind}")
        return None

    def _skip_list(self, levels):
        head = self.byte()
        count = head >> 4 if head >> 4 < 15 else self.varint()
        for _ in range(count):
            if head & 0xF in (TRUE, FALSE):
                self.skip(1)
            else:
                self._value(head & 0xF, levels)


def _sizes(file, begin, end):
    """What each page of a column, between two places of the file, claims to have when it is decompressed."""
    while begin < end:
        file.seek(begin)
        header = _Compact(file.read(MAX_HEADER_BYTES))
        fields = header.structure()
        unpacked, packed = fields[UNCOMPRESSED], fields[COMPRESSED]
        if unpacked < 0 or packed < 0:
            raise ValueError("a page of negative size")
        yield unpacked
        begin += header.at + packed


def uncompressed_bytes(file, metadata):
    """The size of all pages together. `file` is the opened file, `metadata` its pyarrow.parquet.FileMetaData. Raises
    ValueError when they are malformed."""
    total = 0
    try:
        for i in range(metadata.num_row_groups):
            for j in range(metadata.num_columns):
                column = metadata.row_group(i).column(j)
                places = [column.data_page_offset]
                if column.has_dictionary_page:
                    places.append(column.dictionary_page_offset)
                begin = min(places)
                total += sum(_sizes(file, begin, begin + column.total_compressed_size))
    except (KeyError, OSError, OverflowError) as error:
        raise ValueError(f"a page without a valid header: {error!r}") from None
    return total
