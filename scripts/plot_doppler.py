#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/doppler.png: traffic from above, coloured by radial velocity as a driving FMCW LiDAR measures it, and
with the sensor's own velocity removed.

usage: plot_doppler.py GLIDAR_PROGRAM PICTURE.png
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

SCENE = Path(__file__).resolve().parents[1] / "examples" / "traffic.yaml"
SENSOR_SPEED_M_S = 8.0  # of traffic.yaml, along x
X_M, Y_M = (-2.0, 42.0), (8.0, -6.5)  # left to right, top to bottom, in the axes of the sensor
SCALE = 21  # pixels per metre
SIZE = (int(SCALE * (X_M[1] - X_M[0])), int(SCALE * (Y_M[0] - Y_M[1])))
BAR_PX = 34
GROUND = (26, 26, 31)
COLOURS = np.array([(64, 140, 255), (232, 232, 236), (255, 84, 56)], float)  # those of --colour-by radial_velocity
PANELS = ((19.0, "as measured from a car at 8 m/s"), (19.0, "relative to the ground: what moves has a colour"))


def measure(program):
    """Points and radial velocities of the frame, and the velocities without the sensor's own motion."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(
            [program, "render", SCENE, "--quiet", "--no-sidecar", "--drop-invalid", "--columns", "xyz,radial_velocity", "-o", "a.npz"],
            cwd=folder,
            check=True,
        )
        with np.load(Path(folder) / "a.npz") as cloud:
            points, velocities = cloud["xyz"].reshape(-1, 3), cloud["radial_velocity"].ravel()
    forward = points[:, 0] / np.linalg.norm(points, axis=1)
    return points, velocities, velocities + SENSOR_SPEED_M_S * forward


def colours_of(velocities, end):
    place = np.clip(velocities / end + 1.0, 0.0, 2.0)
    below = np.minimum(place.astype(int), 1)
    part = (place - below)[:, None]
    return (COLOURS[below] * (1 - part) + COLOURS[below + 1] * part).astype(np.uint8)


def panel(points, velocities, end, title):
    pixels = np.full((SIZE[1], SIZE[0], 3), GROUND, np.uint8)
    colours = colours_of(velocities, end)
    order = np.argsort(points[:, 2])  # the highest point is drawn
    cols = (SCALE * (points[order, 0] - X_M[0])).astype(int)
    rows = (SCALE * (Y_M[0] - points[order, 1])).astype(int)
    for right in (0, 1):
        for down in (0, 1):
            inside = (cols >= 0) & (cols + right < SIZE[0]) & (rows >= 0) & (rows + down < SIZE[1])
            pixels[rows[inside] + down, cols[inside] + right] = colours[order][inside]
    image = Image.new("RGB", (SIZE[0], SIZE[1] + BAR_PX), (17, 17, 20))
    image.paste(Image.fromarray(pixels), (0, 0))
    draw = ImageDraw.Draw(image)
    x, y = SCALE * (0.0 - X_M[0]), SCALE * Y_M[0]
    draw.polygon([(x + 9, y), (x - 6, y - 6), (x - 6, y + 6)], fill="white")  # the sensor
    draw.text((8, SIZE[1] + 11), title, fill=(222, 222, 228))
    left, width = SIZE[0] - 330, 200
    bar = colours_of(np.linspace(-end, end, width), end)
    image.paste(Image.fromarray(np.repeat(bar[None], 10, axis=0)), (left, SIZE[1] + 12))
    draw.text((left - 30, SIZE[1] + 11), f"-{end:.0f}", fill=(222, 222, 228))
    draw.text((left + width + 6, SIZE[1] + 11), f"{end:.0f} m/s, away", fill=(222, 222, 228))
    return image


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    points, measured, relative = measure(str(Path(sys.argv[1]).resolve()))
    images = [panel(points, v, *text) for v, text in zip((measured, relative), PANELS)]
    picture = Image.new("RGB", (SIZE[0], sum(image.height for image in images) + 6), (17, 17, 20))
    y = 0
    for image in images:
        picture.paste(image, (0, y))
        y += image.height + 6
    picture.quantize(128).save(sys.argv[2], optimize=True)


if __name__ == "__main__":
    main()
