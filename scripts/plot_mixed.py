#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/mixed.png: returns of one line of beams at surfaces with and without gaps
between them, seen from above; those with return_source `mixed_pixel` in red.

usage: plot_mixed.py GLIDAR_PROGRAM PICTURE.png
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

SIZE = (900, 330)
X_M = (-4.4, 4.4)
Z_M = (12.1, 9.0)  # top to bottom; the sensor is below
SENSOR = """optics: {width: 801, height: 1, fx: 1000, fy: 1000}
lidar_equation: {reference_reflectance: 0.01, reference_range_m: 1e4}
footprint: {divergence_mrad: 6, exit_mm: 0, rings: 2}
receiver: {pulse_ns: 5, returns: [strongest]}
"""
# model, scale, position, yaw about the vertical axis y in degrees
MODELS = [("plane", 6.0, (0.0, 0.0, 11.0), 180), ("sphere", 0.5, (-2.9, 0.0, 10.9), 0),
          ("box", 0.4, (-1.1, 0.0, 10.2), 0), ("box", 0.4, (0.7, 0.0, 10.8), 45),
          ("box", 0.25, (2.2, 0.0, 10.75), 0), ("box", 0.2, (3.3, 0.0, 10.55), 0)]
LABELS = [(-3.25, "sphere that"), (-1.45, "box 0.4 m"), (0.35, "box that"), (1.85, "box on"),
          (2.95, "box 0.25 m")]
LABELS2 = [(-3.25, "cuts the wall"), (-1.45, "before it"), (0.35, "cuts the wall"),
           (1.85, "the wall"), (2.95, "before it")]


def measure(program, folder):
    models = "".join(
        f"  - {{model: 'builtin:{model}', scale: {scale}, pose: {{position: [{x}, {y}, {z}], "
        f"euler_deg: {{pitch: {yaw}}}}}, materials: {{'*': {{diffuse: [1, 1, 1]}}}}}}\n"
        for model, scale, (x, y, z), yaw in MODELS)
    (folder / "scene.yaml").write_text(
        f"models:\n{models}sensor: sensor.yaml\nsensor_pose: {{position: [0, 0, 0]}}\n",
        encoding="utf-8")
    (folder / "sensor.yaml").write_text(SENSOR, encoding="utf-8")
    subprocess.run([program, "render", "scene.yaml", "--quiet", "--no-sidecar", "--columns",
                    "range,azimuth,return_source", "-o", "cloud.npz"], cwd=folder, check=True)
    cloud = {name: column.ravel() for name, column in np.load(folder / "cloud.npz").items()}
    seen = np.isfinite(cloud["range"])
    return cloud["range"][seen], cloud["azimuth"][seen], cloud["return_source"][seen]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as name:
        ranges, azimuths, sources = measure(str(Path(sys.argv[1]).resolve()), Path(name))
    picture = Image.new("RGB", SIZE, "white")
    draw = ImageDraw.Draw(picture)
    for x_m, z_m, source in zip(-ranges * np.sin(azimuths), ranges * np.cos(azimuths), sources):
        x = SIZE[0] * (x_m - X_M[0]) / (X_M[1] - X_M[0])
        y = SIZE[1] * (z_m - Z_M[0]) / (Z_M[1] - Z_M[0])
        r = 4 if source == 2 else 2
        colour = (210, 40, 30) if source == 2 else (30, 70, 160)
        draw.ellipse([x - r, y - r, x + r, y + r], outline=colour, fill=colour if r == 4 else None)
    for row, labels in enumerate((LABELS, LABELS2)):
        for x_m, text in labels:
            draw.text((SIZE[0] * (x_m - X_M[0]) / (X_M[1] - X_M[0]), SIZE[1] - 45 + 14 * row), text,
                      fill="black")
    draw.text((8, 6), "blue: surface; red: mixed pixel. One line of beams of 6 mrad, from below.",
              fill="black")
    print(f"{np.sum(sources == 2)} of {len(sources)} returns are mixed")
    picture.convert("P", palette=Image.ADAPTIVE, colors=16).save(sys.argv[2], optimize=True)


if __name__ == "__main__":
    main()
