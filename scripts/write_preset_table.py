#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the list of sensor presets in docs/sensors.md from the list that the program prints.

usage: write_preset_table.py GLIDAR [ROOT]; GLIDAR is the program, ROOT the folder of the sources.
The list is between the lines `<!-- presets -->` and `<!-- end of presets -->`. scripts/plot_presets.py draws the
beam patterns of a group.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

PAGE = "docs/sensors.md"
GROUPS = {"ouster-velodyne": "spinning", "spinning": "spinning, other makers", "solid-state": "solid state, terrestrial",
          "lines": "one line: 2D, airborne", "cameras": "depth cameras", "space": "space"}
# Makers of sensors whose title begins with another word.
MAKERS = {"Azure": "Microsoft", "Intel": "Intel RealSense", "Stereo": "Stereolabs", "Hayabusa": "JAXA", "Hayabusa2": "JAXA",
          "Mars": "NASA", "Flash": "generic", "Woods": "generic"}
# The optics of these do not show that they are for space.
SPACE = {"flash-128", "flash-256", "woods2016-256", "Hayabusa-LIDAR", "Hayabusa2-LIDAR", "MOLA"}
OUSTER_VELODYNE = ("Ouster", "Velodyne")
MARKED = re.compile(r"(<!-- presets -->\n).*?(<!-- end of presets -->)", re.DOTALL)


def presets(program):
    """All presets as the program lists them."""
    listed = subprocess.run([program, "sensors", "--json"], check=True, capture_output=True, text=True)
    return json.loads(listed.stdout)


def group_of(preset):
    if preset["name"] in SPACE:
        return "space"
    if preset["kind"] == "camera":
        return "cameras"
    if preset["rows"] == 1 and preset["kind"] in ("spinning", "line_scan"):
        return "lines"
    if preset["kind"] == "spinning":
        return "ouster-velodyne" if preset["sensor"].startswith(OUSTER_VELODYNE) else "spinning"
    return "solid-state"


def names_text(some_presets):
    """Names of presets by their makers: "A: a1, a2; B: b1"."""
    makers = {}
    for preset in some_presets:
        word = preset["sensor"].split()[0]
        makers.setdefault(MAKERS.get(word, word), []).append(preset["name"])
    return "; ".join(f"{maker}: {', '.join(names)}" for maker, names in sorted(makers.items()))


def lines_of(all_presets):
    """One line for each group of presets."""
    return [f"- {title}. {names_text(preset for preset in all_presets if group_of(preset) == group)}" for group, title in GROUPS.items()]


def written(text, all_presets):
    """The text with the list as it is now."""
    return MARKED.sub(lambda match: match[1] + "\n".join(lines_of(all_presets)) + "\n" + match[2], text)


def main():
    page = Path(sys.argv[2] if len(sys.argv) > 2 else ".") / PAGE
    old = page.read_text(encoding="utf-8")
    new = written(old, presets(sys.argv[1]))
    if new != old:
        page.write_text(new, encoding="utf-8")
        print("wrote", page)


if __name__ == "__main__":
    main()
