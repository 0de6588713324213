# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The only place that prints: texts may be from files."""

import sys

from ._errors import printable


def print_line(text: object) -> None:
    """Prints a line for people to standard output."""
    print(printable(text), flush=True)


def print_message(text: object) -> None:
    """Prints a line to standard error."""
    print(printable(text), file=sys.stderr, flush=True)
