#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/presets/GROUP.png: the beam patterns of the sensor presets, one picture for each group of docs/sensors.md.

usage: plot_presets.py GLIDAR [ROOT], by a Python that has glidar and Matplotlib. GLIDAR is the program.
The names of the presets are in the picture's text chunk "Description", by which a test finds pictures that are out of date.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import write_preset_table as tables

import glidar

COLUMNS = 8
CELL_IN = (1.1, 0.85)
PIXELS = (44, 88)  # of a pattern: rows and columns
DPI = 90


def angles_deg(sensor):
    """Azimuth to the right and elevation of the beams of a frame, from the boresight, as two arrays."""
    x, y, z = sensor.ray_directions.reshape(-1, 3).T
    forward, left, up = (z, -x, -y) if sensor.boresight == "z" else (x, y, z)
    seen = ~np.isnan(forward)
    return np.degrees(-np.arctan2(left, forward))[seen], np.degrees(np.arcsin(np.clip(up, -1, 1)))[seen]


def extent_of(values):
    """The range that a picture shows."""
    margin = max(0.04 * np.ptp(values), 0.5)
    return values.min() - margin, values.max() + margin


def draw_pattern(ax, preset):
    azimuth, elevation = angles_deg(glidar.load_sensor(preset["name"]))
    extent = (extent_of(elevation), extent_of(azimuth))
    density, _, _ = np.histogram2d(elevation, azimuth, bins=PIXELS, range=extent)
    ax.imshow(np.sqrt(density), origin="lower", aspect="auto", cmap="magma", interpolation="nearest")
    ax.set_title(preset["name"], fontsize=6, pad=2)
    ax.set_xlabel("{:.0f}° x {:.0f}°".format(*preset["view_deg"]), fontsize=5.5, labelpad=1)
    ax.set_xticks([])
    ax.set_yticks([])


def draw_group(presets, picture):
    rows = -(-len(presets) // COLUMNS)
    size = (COLUMNS * CELL_IN[0], rows * CELL_IN[1])
    figure, axes = plt.subplots(rows, COLUMNS, figsize=size, layout="constrained", squeeze=False)
    for ax in axes.flat[len(presets):]:
        ax.axis("off")
    for ax, preset in zip(axes.flat, presets):
        draw_pattern(ax, preset)
    names = " ".join(preset["name"] for preset in presets)
    figure.savefig(picture, dpi=DPI, metadata={"Description": names, "Software": None},
                   pil_kwargs={"optimize": True})
    plt.close(figure)


def main():
    root = Path(sys.argv[2] if len(sys.argv) > 2 else ".")
    folder = root / "docs/images/presets"
    folder.mkdir(parents=True, exist_ok=True)
    all_presets = tables.presets(sys.argv[1])
    for group in tables.GROUPS:
        presets = [preset for preset in all_presets if tables.group_of(preset) == group]
        if presets:
            draw_group(presets, folder / f"{group}.png")
            print("wrote", folder / f"{group}.png")


if __name__ == "__main__":
    main()
