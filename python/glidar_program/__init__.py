# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The command `glidar`: runs the program that the package brings along. A package of its own, so that the
program does not wait for NumPy."""

import os
import sys
from pathlib import Path


def main() -> None:
    program = Path(__file__).resolve().parent.parent / "glidar" / "bin" / "glidar"
    # where `glidar campaign` finds glidar-campaign, also in an environment that is not activated
    path = os.pathsep.join([str(Path(sys.argv[0]).resolve().parent), os.environ.get("PATH", os.defpath)])
    os.execve(program, ["glidar", *sys.argv[1:]], {**os.environ, "PATH": path})
