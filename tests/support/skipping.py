# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Ends a test program that lacks something: the only way in which the Python programs of CTest skip all their tests.
Their last line is what ./dev test prints."""

import contextlib
import sys

SKIPPED = 77  # CTest's SKIP_RETURN_CODE
IN_DEV = "./dev test installs it, with apt-get or from PyPI"
IN_CTEST = "run it by ./dev test -R NAME"


def skip(reason, remedy):
    """Ends the program as skipped; the remedy is what lets it run."""
    print(f"skipped: {reason}; {remedy}", flush=True)
    sys.exit(SKIPPED)


@contextlib.contextmanager
def importing(remedy=IN_DEV):
    """For the import of packages that may be missing."""
    try:
        yield
    except ImportError as missing:
        skip(missing, remedy)
