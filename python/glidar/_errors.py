# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The only exception type of GLIDAR."""

import reprlib

from . import _core

MAX_QUOTED_BYTES = 200
_BRIEF = reprlib.Repr()
_BRIEF.maxstring = _BRIEF.maxother = MAX_QUOTED_BYTES


def _utf8(text: object) -> str:
    """Text that C++ takes: Python's may have halves of surrogate pairs, for bytes of file names."""
    return str(text).encode("utf-8", "backslashreplace").decode()


def excerpt(text: object, max_bytes: int = MAX_QUOTED_BYTES) -> str:
    """Text of a file or an argument for an error: a printable line of at most `max_bytes`."""
    return _core.excerpt(_utf8(text), max_bytes)


def printable(text: object) -> str:
    """The text as a line that people may see: '?' replaces control characters, those that change the order of others
    or are invisible, and bytes that are not UTF-8. Everything that is printed passes through this function."""
    return _core.printable_line(_utf8(text))


def shown(value: object) -> str:
    """A value as Python prints it, shortened by excerpt()."""
    try:
        return excerpt(_BRIEF.repr(value))
    except Exception:  # raised by the __repr__ of the caller's class
        return f"a {type(value).__name__}"


class Error(Exception):
    """Invalid input. ``str`` is the message that the command line prints: one printable line, whatever the input
    contains, like all attributes.

    Attributes:
        where: file:line:column, field, argument or file name.
        found: what is wrong, with the value that was found.
        allowed: what is allowed; empty when that is obvious.
        remedy: how to fix it; empty when that is obvious.
    """

    def __init__(self, where: str, found: str, allowed: str = "", remedy: str = "") -> None:
        self.where, self.found, self.allowed, self.remedy = map(printable, (where, found, allowed, remedy))
        super().__init__(self.where, self.found, self.allowed, self.remedy)

    def __str__(self) -> str:
        return _core.error_text(*map(_utf8, (self.where, self.found, self.allowed, self.remedy)))
