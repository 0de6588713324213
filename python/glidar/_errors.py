# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The only exception type of GLIDAR."""

import re
import reprlib

from . import _core

MAX_QUOTED_BYTES = 200
_BRIEF = reprlib.Repr()
_BRIEF.maxstring = _BRIEF.maxother = MAX_QUOTED_BYTES
_CONTROL = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029]")


def excerpt(text: object, max_bytes: int = MAX_QUOTED_BYTES) -> str:
    """Text of a file or an argument for an error: one line of at most `max_bytes`, without control characters."""
    data = _CONTROL.sub("?", str(text)).encode("utf-8", "backslashreplace")
    return data.decode() if len(data) <= max_bytes else data[: max_bytes - 3].decode("utf-8", "ignore") + "..."


def shown(value: object) -> str:
    """A value as Python prints it, shortened by excerpt()."""
    try:
        return excerpt(_BRIEF.repr(value))
    except Exception:  # raised by the __repr__ of the caller's class
        return f"a {type(value).__name__}"


class Error(Exception):
    """Invalid input. ``str`` is the message that the command line prints.

    Attributes:
        where: file:line:column, field, argument or file name.
        found: what is wrong, with the value that was found.
        allowed: what is allowed; empty when that is obvious.
        remedy: how to fix it; empty when that is obvious.
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
