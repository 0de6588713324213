#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/weather.png: what weather takes from glidar's light, against weather.md's laws.

usage: plot_weather.py GLIDAR_PROGRAM PICTURE.png
"""

import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

PANEL = (300, 220)
MARGIN = (50, 22, 12, 28)  # left, top, right, bottom
DISTANCE_M = 50.0
VISIBILITIES_KM = [0.1, 0.2, 0.4, 0.7, 1.0, 2.0, 4.0, 8.0, 20.0, 40.0]
RATES_MM_PER_H = [0.5, 1, 2, 4, 8, 16, 32, 64]
COLOURS = [(200, 60, 40), (30, 70, 160)]


def fog(model, nanometres):
    def law(visibility_km):
        v = visibility_km
        q = 1.3 if v > 6 else 0.585 * v ** (1 / 3) if model == "kruse" else \
            0.16 * v + 0.34 if v > 1 else v - 0.5 if v > 0.5 else 0.0
        return 3.912 / v * (nanometres / 550) ** -q
    return f"{nanometres} nm", law, lambda v: f"visibility_m: {1e3 * v}, fog_model: {model}", nanometres


def falling(kind, model, law):
    return model, law, lambda rate: f"{kind}_mm_per_h: {rate}, {kind}_model: {model}", 905


def drops_per_km(number, slope_per_mm):
    return 1e-3 * math.pi * number / slope_per_mm ** 3


# title, places, their unit, two laws of the extinction in 1/km
PANELS = [
    ("fog, Kim", VISIBILITIES_KM, "km", [fog("kim", 905), fog("kim", 1550)]),
    ("fog, Kruse", VISIBILITIES_KM, "km", [fog("kruse", 905), fog("kruse", 1550)]),
    ("rain", RATES_MM_PER_H, "mm/h",
     [falling("rain", "geometric", lambda r: drops_per_km(8000, 4.1 * r ** -0.21)),
      falling("rain", "goodin", lambda r: 10 * r ** 0.6)]),
    ("snow", RATES_MM_PER_H, "mm/h",
     [falling("snow", "gunn_marshall",
              lambda r: drops_per_km(7600 * r ** -0.87, 2.55 * r ** -0.48)),
      falling("snow", "sekhon_srivastava",
              lambda r: drops_per_km(2500 * r ** -0.94, 2.29 * r ** -0.45))]),
]


def intensities(program, weather, nanometres, folder):
    """Of a camera before a plane."""
    (folder / "sensor.yaml").write_text(
        f"optics: {{width: 16, height: 12, fov_deg: 0.5}}\nwavelength_nm: {nanometres}\n"
        "lidar_equation: {reference_reflectance: 0.01, reference_range_m: 1e6}\n"
        "receiver: {returns: [last]}\n"  # the plane, behind the echoes of the air
        f"weather: {{fog_backscatter_per_sr: 0{weather}}}\n", encoding="utf-8")
    subprocess.run(
        [program, "render", "builtin:plane", "--sensor", "sensor.yaml", "--eye",
         f"0,0,{DISTANCE_M}", "--target", "0,0,0", "--up-vector", "0,1,0", "--columns",
         "range,intensity", "--quiet", "-o", "cloud.npz"], cwd=folder, check=True)
    cloud = np.load(folder / "cloud.npz")
    return cloud["range"].astype(float), cloud["intensity"].astype(float)


def measured_per_km(program, weather, nanometres, folder):
    range_m, clear = intensities(program, "", nanometres, folder)
    _, dimmed = intensities(program, ", " + weather, nanometres, folder)
    return 1e3 * float(np.nanmean(-np.log(dimmed / clear) / (2.0 * range_m)))


def draw_panel(draw, corner, panel, curves):
    title, places, unit, laws = panel
    left, top, right, bottom = MARGIN
    values = [y for curve in curves for y in curve]
    x_ends = math.log10(places[0]) - 0.1, math.log10(places[-1]) + 0.1
    y_ends = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))

    def place(x, y):
        along = (math.log10(x) - x_ends[0]) / (x_ends[1] - x_ends[0])
        up = (math.log10(y) - y_ends[0]) / (y_ends[1] - y_ends[0])
        return (corner[0] + left + (PANEL[0] - left - right) * along,
                corner[1] + PANEL[1] - bottom - (PANEL[1] - top - bottom) * up)

    draw.text((corner[0] + left, corner[1] + 5), f"{title}: extinction in 1/km", fill="black")
    low, high = 10.0 ** y_ends[0], 10.0 ** y_ends[1]
    first, last = 10.0 ** x_ends[0], 10.0 ** x_ends[1]
    draw.line([place(first, high), place(first, low), place(last, low)], fill="black")
    for k in range(y_ends[0], y_ends[1] + 1):
        x, y = place(first, 10.0 ** k)
        draw.line([(x - 3, y), (x, y)], fill="black")
        draw.text((x - 34, y - 5), f"{10.0 ** k:g}", fill="black")
    for k in range(math.ceil(x_ends[0]), math.floor(x_ends[1]) + 1):
        x, y = place(10.0 ** k, low)
        draw.line([(x, y), (x, y + 3)], fill="black")
        draw.text((x - 6, y + 4), f"{10.0 ** k:g}", fill="black")
    draw.text((corner[0] + PANEL[0] - 40, corner[1] + PANEL[1] - 14), unit, fill="black")
    for k, ((name, law, _, _), curve) in enumerate(zip(laws, curves)):
        xs = np.geomspace(places[0], places[-1], 300)
        draw.line([place(x, law(x)) for x in xs], fill=COLOURS[k])
        for x, y in zip(places, curve):
            px, py = place(x, y)
            draw.ellipse([px - 3, py - 3, px + 3, py + 3], outline=COLOURS[k])
        draw.text((corner[0] + left + 130, corner[1] + top + 12 * k), name, fill=COLOURS[k])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program = str(Path(sys.argv[1]).resolve())
    picture = Image.new("RGB", (2 * PANEL[0], 2 * PANEL[1]), "white")
    draw = ImageDraw.Draw(picture)
    with tempfile.TemporaryDirectory() as name:
        for k, panel in enumerate(PANELS):
            title, places, _, laws = panel
            curves = []
            for label, law, weather, nanometres in laws:
                curves.append([measured_per_km(program, weather(x), nanometres, Path(name))
                               for x in places])
                worst = max(abs(y / law(x) - 1.0) for x, y in zip(places, curves[-1]))
                print(f"{title}, {label}: measured within {100 * worst:.3f} % of the law")
            draw_panel(draw, (k % 2 * PANEL[0], k // 2 * PANEL[1]), panel, curves)
    picture.convert("P", palette=Image.ADAPTIVE, colors=16).save(sys.argv[2], optimize=True)


if __name__ == "__main__":
    main()
