#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Cuts the font of pictures, glidar/io/pictures/font/DejaVuSans-subset.ttf, out of DejaVu Sans.

usage: make_font.py [DejaVuSans.ttf]; the default is that of Debian's fonts-dejavu-core 2.37.
Needs fontTools (scripts/requirements.txt: a dependency of matplotlib).
"""

import sys
from pathlib import Path

from fontTools import subset

SOURCE = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
TARGET = Path(__file__).resolve().parents[1] / "glidar" / "io" / "pictures" / "font" / "DejaVuSans-subset.ttf"
# ASCII, Latin-1, Latin Extended-A, Greek, Cyrillic; dashes, the ellipsis, minus, not greater, not less
CHARACTERS = [range(0x20, 0x7F), range(0xA0, 0x180), range(0x391, 0x3CA), range(0x410, 0x450),
              [0x2013, 0x2014, 0x2026, 0x2212, 0x2264, 0x2265]]


def main():
    options = subset.Options(hinting=False, layout_features=[], notdef_outline=True, name_IDs=[])
    options.drop_tables += ["GSUB", "GPOS", "GDEF", "FFTM", "kern", "name"]
    options.recalc_timestamp = False  # the same bytes each time
    font = subset.load_font(sys.argv[1] if len(sys.argv) > 1 else SOURCE, options)
    cutter = subset.Subsetter(options)
    cutter.populate(unicodes=[code for characters in CHARACTERS for code in characters])
    cutter.subset(font)
    subset.save_font(font, TARGET, options)


if __name__ == "__main__":
    main()
