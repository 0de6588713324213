#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the tables of sensor presets in docs/presets/ from the list that the program prints.

usage: write_preset_table.py GLIDAR [ROOT]; GLIDAR is the program, ROOT the folder of the sources.
A table is between the lines `<!-- presets: GROUP -->` and `<!-- end of presets -->`. scripts/plot_presets.py draws the
beam patterns of a group.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

GROUPS = ("ouster-velodyne", "spinning", "solid-state", "lines", "cameras", "space")
# The optics of these do not show that they are for space.
SPACE = {"flash-128", "flash-256", "woods2016-256", "Hayabusa-LIDAR", "Hayabusa2-LIDAR", "MOLA"}
OUSTER_VELODYNE = ("Ouster", "Velodyne")
MARKED = re.compile(r"(<!-- presets: (\S+) -->\n).*?(<!-- end of presets -->)", re.DOTALL)
COLUMNS = ("name", "sensor", "rows x cols", "view, degrees", "rate, Hz", "range, m", "detection range")


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


def range_text(preset):
    near = f"{preset['near_m']:g}"
    return f"from {near}" if preset["far_m"] is None else f"{near} to {preset['far_m']:g}"


def detection_text(preset):
    detection = preset["detection"]
    if not detection:
        return "-"
    star = "" if detection["documented"] else "\\*"
    return f"{detection['range_m']:g} at {100 * detection['reflectance']:g} %{star}"


def row(cells):
    return "| " + " | ".join(cells) + " |"


def cells_of(preset):
    across, upright = preset["view_deg"]
    return (preset["name"], preset["sensor"], f"{preset['rows']} x {preset['cols']}", f"{across:.1f} x {upright:.1f}",
            f"{preset['rate_hz']:g}", range_text(preset), detection_text(preset))


def table(all_presets, group):
    lines = [row(COLUMNS), "|---" * len(COLUMNS) + "|"]
    return lines + [row(cells_of(preset)) for preset in all_presets if group_of(preset) == group]


def written(text, all_presets):
    """The text with the tables as they are now."""
    def replaced(match):
        return match[1] + "\n".join(table(all_presets, match[2])) + "\n" + match[3]
    return MARKED.sub(replaced, text)


def main():
    root = Path(sys.argv[2] if len(sys.argv) > 2 else ".")
    all_presets = presets(sys.argv[1])
    for page in sorted(root.glob("docs/presets/*.md")):
        old = page.read_text(encoding="utf-8")
        new = written(old, all_presets)
        if new != old:
            page.write_text(new, encoding="utf-8")
            print("wrote", page)


if __name__ == "__main__":
    main()
