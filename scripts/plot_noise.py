#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/noise.png: errors that glidar makes on a plane, against the laws of noise.md.

usage: plot_noise.py GLIDAR_PROGRAM PICTURE.png
"""

import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

PANEL = (300, 200)
MARGIN = (46, 22, 10, 26)  # left, top, right, bottom
DEPTHS_M = [0.6, 0.9, 1.3, 1.8, 2.4, 3.1, 3.9, 4.8]
STEREO_M = 674.0 * 0.05
LIGHT = 299792458.0


def electrons_sigma_mm():
    """Lange and Seitz at 16 MHz: A = 20000 (intensity 1 here), B = 5000, contrast 0.6."""
    return 1e3 * LIGHT / (4 * math.sqrt(2) * math.pi * 16e6) * math.sqrt(25000) / (0.6 * 20000)


# title, step of noise, standard deviation of depth in mm at a depth in m
CASES = [
    ("range_gaussian 5 mm + 2 mm/m", "{type: range_gaussian, sigma_m: 0.005, sigma_per_m: 0.002}",
     lambda z: 5.0 + 2.0 * z),
    ("khoshelham", "{type: khoshelham}", lambda z: 1.425 * z * z),
    ("nguyen_axial", "{type: nguyen_axial}", lambda z: 1.2 + 1.9 * (z - 0.4) ** 2),
    ("stereo, f 674 px, b 50 mm, 0.08 px",
     "{type: stereo, focal_px: 674, baseline_m: 0.05, sigma_px: 0.08}",
     lambda z: 1e3 * z * z * 0.08 / STEREO_M),
    ("icl_kinect (steps of z^2/K)", "{type: icl_kinect}",
     lambda z: 1e3 * z * z / 351.3 * math.sqrt(1 / 36 + 1 / 12)),
    ("continuous_wave, 16 MHz",
     "{type: continuous_wave, frequencies_hz: [16e6], electrons_at_full_scale: 20000, "
     "background_electrons: 5000, contrast: 0.6}", lambda z: electrons_sigma_mm()),
]


def measured_mm(program, step, depth_m, folder):
    """Standard deviation of the error along the boresight, of a camera before a plane. Depths are
    spread over a step of disparity, as those of a surface are."""
    (folder / "sensor.yaml").write_text(
        "optics: {width: 160, height: 120, fov_deg: 0.5}\n"
        "light: {attenuation: {constant: 1, linear_per_m: 0, quadratic_per_m2: 0}, ambient: 0}\n"
        f"noise: [{step}]\n", encoding="utf-8")
    (folder / "scene.yaml").write_text(
        "models: [{model: 'builtin:plane', materials: {'*': {diffuse: [1, 1, 1], "
        "specular: [0, 0, 0]}}}]\n", encoding="utf-8")
    errors = []
    for k in range(6):
        z = 1.0 / (1.0 / depth_m + k / 6 / 351.3)
        subprocess.run(
            [program, "render", "scene.yaml", "--sensor", "sensor.yaml", "--eye", f"0,0,{z!r}",
             "--target", "0,0,0", "--up-vector", "0,1,0", "--columns", "depth", "--seed", str(k),
             "--quiet", "-o", "cloud.npz"], cwd=folder, check=True)
        errors.append(np.load(folder / "cloud.npz")["depth"].ravel() - z)
    return 1e3 * float(np.nanstd(np.concatenate(errors)))


def draw_panel(draw, corner, title, points, law):
    left, top, right, bottom = MARGIN
    width = PANEL[0] - left - right
    height = PANEL[1] - top - bottom
    highest = 1.15 * max(max(y for _, y in points), max(law(z) for z in DEPTHS_M))

    def place(z, y):
        return (corner[0] + left + width * z / 5.0,
                corner[1] + top + height * (1.0 - y / highest))

    draw.text((corner[0] + left, corner[1] + 5), title, fill="black")
    draw.line([place(0, highest), place(0, 0), place(5, 0)], fill="black")
    for z in range(6):
        x, y = place(z, 0)
        draw.line([(x, y), (x, y + 3)], fill="black")
        draw.text((x - (13 if z == 5 else 3), y + 4), f"{z} m" if z == 5 else str(z), fill="black")
    for share in (0.5, 1.0):
        x, y = place(0, share * highest / 1.15)
        draw.line([(x - 3, y), (x, y)], fill="black")
        draw.text((x - 42, y - 5), f"{share * highest / 1.15:.3g} mm", fill="black")
    draw.line([place(0.4 + 0.05 * k, law(0.4 + 0.05 * k)) for k in range(92)], fill=(200, 60, 40))
    for z, y in points:
        x, y = place(z, y)
        draw.ellipse([x - 3, y - 3, x + 3, y + 3], outline=(30, 70, 160))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program = str(Path(sys.argv[1]).resolve())
    picture = Image.new("RGB", (3 * PANEL[0], 2 * PANEL[1]), "white")
    draw = ImageDraw.Draw(picture)
    with tempfile.TemporaryDirectory() as name:
        for k, (title, step, law) in enumerate(CASES):
            points = [(z, measured_mm(program, step, z, Path(name))) for z in DEPTHS_M]
            worst = max(abs(y / law(z) - 1.0) for z, y in points)
            print(f"{title}: measured within {100 * worst:.1f} % of the law")
            draw_panel(draw, (k % 3 * PANEL[0], k // 3 * PANEL[1]), title, points, law)
    picture.convert("P", palette=Image.ADAPTIVE, colors=16).save(sys.argv[2], optimize=True)


if __name__ == "__main__":
    main()
