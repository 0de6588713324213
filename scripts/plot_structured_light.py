#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/structured-light.png: what examples/scanner.yaml measures of a sphere before a wall, and prints the
median error of the depth.

usage: plot_structured_light.py [ROOT], by a Python that has glidar and Matplotlib.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

import glidar

DPI = 90
COLOURS = 128  # so that noise takes little space
STATUS_COLOURS = {glidar.Status.hit: (235, 235, 235), glidar.Status.saturated: (240, 200, 40),
                  glidar.Status.projector_shadow: (30, 30, 30), glidar.Status.low_modulation: (110, 110, 110),
                  glidar.Status.weak_code: (225, 110, 40), glidar.Status.inconsistent_code: (50, 110, 200),
                  glidar.Status.outside_projector: (150, 90, 200)}


def scene():
    """In the optical frame of the camera."""
    result = glidar.Scene()
    result.add_model("builtin:box:size=2,2,0.1", pose=glidar.pose((0.0, 0.0, 1.0)))
    result.add_model("builtin:sphere:radius=0.1", pose=glidar.pose((0.0, 0.0, 0.8)))
    return result


def status_picture(status):
    picture = np.zeros((*status.shape, 3), np.uint8)
    for number, colour in STATUS_COLOURS.items():
        picture[status == number] = colour
    return picture


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent)
    path = root / "examples/scanner.yaml"
    frame = glidar.simulate(scene(), glidar.load_sensor(path), np.eye(4))
    images = np.array([image.grey for image in frame.raw_images.values()])
    found = glidar.StructuredLight(path).decode(images)
    error_mm = 1000 * np.nanmedian(np.abs(frame.range_m - frame.ground_truth.range_m))
    print(f"median error {error_mm:.3f} mm;", {name.name: int((frame.status == name).sum()) for name in STATUS_COLOURS})
    shown = [(images[0], "gray", "fringes"), (images[-6], "gray", "Gray code"), (found.phase_rad, "twilight", "phase"),
             (found.depth_m, "viridis", f"depth, median error {error_mm:.2f} mm"), (status_picture(frame.status), None, "status")]
    figure, axes = plt.subplots(1, len(shown), figsize=(12, 2.2), dpi=DPI, layout="constrained")
    for axis, (image, colours, title) in zip(axes, shown):
        axis.imshow(image, cmap=colours)
        axis.set_title(title, fontsize=9)
        axis.set_axis_off()
    picture = root / "docs/images/structured-light.png"
    figure.savefig(picture)
    Image.open(picture).convert("RGB").quantize(COLOURS).save(picture, optimize=True)


if __name__ == "__main__":
    main()
