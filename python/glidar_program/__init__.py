# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The command `glidar`: runs the program that the package brings along. A package of its own, so that the
program does not wait for NumPy."""

import os
import sys
from pathlib import Path


def main() -> None:
    program = Path(__file__).resolve().parent.parent / "glidar" / "bin" / "glidar"
    os.execv(program, ["glidar", *sys.argv[1:]])
