#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the models of the models/ folder, the same each time. Needs numpy and Pillow."""

import argparse
from pathlib import Path

from modelmaker.asteroid import make_asteroid
from modelmaker.satellite import make_satellite
from modelmaker.street import make_street

MAKERS = {"asteroid": make_asteroid, "satellite": make_satellite, "street": make_street}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", default=list(MAKERS),
                        help="models to make: " + ", ".join(MAKERS) + " (default: all)")
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parents[1] / "models",
                        help="folder to write to, one folder per model (default: models/)")
    arguments = parser.parse_args()
    for name in arguments.names:
        if name not in MAKERS:
            parser.error(f"no model named '{name}'; known: {', '.join(MAKERS)}")
        folder = arguments.out / name
        folder.mkdir(parents=True, exist_ok=True)
        MAKERS[name](folder)


if __name__ == "__main__":
    main()
