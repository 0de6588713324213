# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The one exception type of GLIDAR."""

import re
import reprlib

from . import _core

MOST_QUOTED_BYTES = 200
_BRIEF = reprlib.Repr()
_BRIEF.maxstring = _BRIEF.maxother = MOST_QUOTED_BYTES
_CONTROL = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029]")


def excerpt(text: object, most: int = MOST_QUOTED_BYTES) -> str:
    """What an error quotes of a file or an argument: one line of at most so many bytes, without control characters."""
    data = _CONTROL.sub("?", str(text)).encode("utf-8", "backslashreplace")
    return data.decode() if len(data) <= most else data[: most - 3].decode("utf-8", "ignore") + "..."


def shown(value: object) -> str:
    """A value as Python writes it, as excerpt() cuts it."""
    try:
        return excerpt(_BRIEF.repr(value))
    except Exception:  # of a class of the caller's
        return f"a {type(value).__name__}"


class Error(Exception):
    """Bad input, told as the command line tells it.

    Attributes:
        where: file:line:column, field, argument or file name.
        found: what is wrong, with the value found.
        allowed: what would be right; empty if it says itself.
        remedy: what to do; empty if it says itself.
    """

    def __init__(self, where: str, found: str, allowed: str = "", remedy: str = "") -> None:
        super().__init__(where, found, allowed, remedy)
        self.where = where
        self.found = found
        self.allowed = allowed
        self.remedy = remedy

    def __str__(self) -> str:
        parts = (self.where, self.found, self.allowed, self.remedy)
        return _core.error_text(*(str(part).encode("utf-8", "backslashreplace").decode() for part in parts))
