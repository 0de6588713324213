# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The command `glidar`: runs the program of the package. It is a package of its own, because importing `glidar` loads
NumPy."""

import os
import sys
from pathlib import Path


def main() -> None:
    program = Path(__file__).resolve().parent.parent / "glidar" / "bin" / "glidar"
    # lets `glidar campaign` find glidar-campaign, also when the environment is not activated
    path = os.pathsep.join([str(Path(sys.argv[0]).resolve().parent), os.environ.get("PATH", os.defpath)])
    os.execve(program, ["glidar", *sys.argv[1:]], {**os.environ, "PATH": path})
