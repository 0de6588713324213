#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/depth-filters.png and depth-alignment.png: a box before a wall, measured by a D435, after filters and at
the pixels of a colour camera.

usage: plot_depth_filters.py [ROOT], by a Python that has glidar and Matplotlib.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

import glidar

FRAMES = 8
BASELINE_M = 0.05015
DPI = 90
COLOURS = 128
STAGES = [
    ("D435", []),
    ("spatial", ["spatial"]),
    ("spatial, temporal", ["spatial", "temporal"]),
    ("and hole filling", ["spatial", "temporal", "hole_filling"]),
]


def save(figure, path):
    """With few colours, so that noise takes little space."""
    figure.savefig(path)
    Image.open(path).convert("RGB").quantize(COLOURS).save(path, optimize=True)


def scene():
    """A wall at 2 m, and a box and a sphere before it, in the optical frame of the camera."""
    result = glidar.Scene()
    for name, position in (("builtin:box:size=4,3,0.1", (0.0, 0.0, 2.05)), ("builtin:box:size=0.4,0.5,0.3", (-0.25, 0.05, 1.3)),
                           ("builtin:sphere:radius=0.2", (0.35, 0.0, 1.4))):
        result.add_model(name, pose=glidar.pose(position))
    return result


def measured(sensor):
    """Depths and true depths of all frames, m; a share of the pixels is lost."""
    frames = list(glidar.simulate_iter(scene(), sensor, [np.eye(4)] * FRAMES))
    random = np.random.default_rng(1)
    depth_per_range = sensor.ray_directions[..., 2]
    depths = [np.where(random.random(frame.range_m.shape) < 0.04, np.nan, frame.range_m * depth_per_range) for frame in frames]
    return depths, frames[0].ground_truth.range_m * depth_per_range


def filtered(depths, names, focal_length_px):
    """The last frame after the filters, which smooth disparities."""
    smoothing = [name for name in names if name != "hole_filling"]
    around = [{"type": "to_disparity", "baseline_m": BASELINE_M}, *smoothing, "to_depth"] if smoothing else []
    filters = glidar.DepthFilters(around + names[len(smoothing):], focal_length_px=focal_length_px)
    return [filters.apply(depth) for depth in depths][-1]


def draw_filters(path, depths, truth, focal_length_px):
    figure, axes = plt.subplots(2, len(STAGES), figsize=(10, 3.4), dpi=DPI, layout="constrained")
    for (title, names), (above, below) in zip(STAGES, axes.T):
        depth = filtered(depths, names, focal_length_px)
        above.imshow(depth, cmap="viridis", vmin=1.0, vmax=2.2)
        error = below.imshow(1000 * (depth - truth), cmap="RdBu", vmin=-20, vmax=20)
        above.set_title(f"{title}: {100 * np.isfinite(depth).mean():.1f} % valid", fontsize=9)
        below.set_title(f"median error {1000 * np.nanmedian(abs(depth - truth)):.1f} mm", fontsize=9)
    for axis in axes.flat:
        axis.set_axis_off()
    figure.colorbar(error, ax=axes[1], label="error, mm")
    save(figure, path)


def draw_alignment(path, depth, root):
    aligned = glidar.DepthAligner(root / "examples/d435_cameras.yaml").align(depth).depth
    figure, axes = plt.subplots(1, 2, figsize=(8, 2.6), dpi=DPI, layout="constrained")
    for axis, image, title in zip(axes, (depth, aligned), ("depth camera, 848x480", "at the pixels of the colour camera, 1280x720")):
        axis.set_facecolor("black")
        axis.imshow(image, cmap="viridis", vmin=1.0, vmax=2.2)
        axis.set_title(title, fontsize=9)
        axis.set_xticks([])
        axis.set_yticks([])
        rows, columns = image.shape
        axis.set_xlim(0.12 * columns, 0.8 * columns)
        axis.set_ylim(0.85 * rows, 0.15 * rows)
    save(figure, path)


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent)
    sensor = glidar.sensor("D435")
    focal_length_px = sensor.to_dict()["optics"]["fx"]
    depths, truth = measured(sensor)
    draw_filters(root / "docs/images/depth-filters.png", depths, truth, focal_length_px)
    draw_alignment(root / "docs/images/depth-alignment.png", truth, root)


if __name__ == "__main__":
    main()
