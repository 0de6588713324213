# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The one exception type of GLIDAR."""

from . import _core


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
        return _core.error_text(self.where, self.found, self.allowed, self.remedy)
