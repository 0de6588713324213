#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/fog_echoes.png: ranges and signals of fog's echoes by `fog_looks`.

usage: plot_fog.py GLIDAR_PROGRAM PICTURE.png
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

PANEL = (400, 240)
MARGIN = (46, 26, 12, 34)  # left, top, right, bottom
LOOKS = [1, 4, 16]
COLOURS = [(200, 60, 40), (30, 70, 160), (60, 130, 60)]
SENSOR = """optics: {width: 200, height: 100, fov_deg: 0.5}
wavelength_nm: 903
lidar_equation: {reference_reflectance: 0.9, reference_range_m: 100}
receiver: {pulse_ns: 5, returns: [first]}
"""


def echoes(program, looks, folder):
    """Ranges and signals of a camera that looks through fog of 50 m visibility."""
    (folder / "sensor.yaml").write_text(
        SENSOR + f"weather: {{visibility_m: 50, fog_looks: {looks}, min_signal: 1}}\n",
        encoding="utf-8")
    subprocess.run(
        [program, "render", "builtin:plane", "--sensor", "sensor.yaml", "--eye", "0,0,30",
         "--target", "0,0,0", "--up-vector", "0,1,0", "--columns", "range,intensity,return_source",
         "--quiet", "-o", "cloud.npz"], cwd=folder, check=True)
    cloud = np.load(folder / "cloud.npz")
    fog = cloud["return_source"].ravel() == 5
    return cloud["range"].ravel()[fog].astype(float), cloud["intensity"].ravel()[fog].astype(float)


def draw_panel(draw, corner, title, unit, ends, samples, line):
    """Histograms of samples, one a colour, each as a share of its beams; a line where even fog is."""
    left, top, right, bottom = MARGIN
    bins = np.linspace(*ends, 61)
    shares = [np.histogram(sample, bins)[0] / len(sample) for sample in samples]
    high = 1.1 * max(share.max() for share in shares)

    def place(x, y):
        return (corner[0] + left + (PANEL[0] - left - right) * (x - ends[0]) / (ends[1] - ends[0]),
                corner[1] + PANEL[1] - bottom - (PANEL[1] - top - bottom) * min(y / high, 1.0))

    draw.text((corner[0] + left, corner[1] + 6), title, fill="black")
    draw.line([place(ends[0], high), place(ends[0], 0), place(ends[1], 0)], fill="black")
    for k in range(int(np.ceil(ends[0])), int(ends[1]) + 1, max(1, int(ends[1]) // 6)):
        x, y = place(k, 0)
        draw.line([(x, y), (x, y + 3)], fill="black")
        draw.text((x - 6, y + 5), str(k), fill="black")
    draw.text((corner[0] + PANEL[0] - 40, corner[1] + PANEL[1] - 15), unit, fill="black")
    draw.text((corner[0] + 4, corner[1] + top), f"{100 * high:.0f} %", fill="black")
    draw.line([place(line, 0), place(line, high)], fill=(120, 120, 120))
    draw.text((place(line, high)[0] + 3, corner[1] + top), "even fog", fill=(120, 120, 120))
    for k, (share, sample) in enumerate(zip(shares, samples)):
        points = [place(x, y) for i, y in enumerate(share) for x in (bins[i], bins[i + 1])]
        draw.line(points, fill=COLOURS[k])
        draw.text((corner[0] + PANEL[0] - 190, corner[1] + top + 14 * (k + 1)),
                  f"fog_looks {LOOKS[k]}: {sample.mean():.2f} +- {sample.std():.2f}", fill=COLOURS[k])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program = str(Path(sys.argv[1]).resolve())
    picture = Image.new("RGB", (2 * PANEL[0], PANEL[1]), "white")
    draw = ImageDraw.Draw(picture)
    with tempfile.TemporaryDirectory() as name:
        even_range, even_signal = echoes(program, 0, Path(name))
        ranges, signals = zip(*(echoes(program, looks, Path(name)) for looks in LOOKS))
    draw_panel(draw, (0, 0), "range of fog's echoes, 50 m visibility, 5 ns", "m", (0.8, 5.0), ranges,
               even_range.mean())
    draw_panel(draw, (PANEL[0], 0), "signal of these echoes, over the threshold", "S", (0.0, 60.0),
               signals, even_signal.mean())
    for looks, r, s in zip(LOOKS, ranges, signals):
        print(f"fog_looks {looks}: range {r.mean():.3f} +- {r.std():.3f} m, signal {s.mean():.2f} "
              f"+- {s.std():.2f}; even {even_range.mean():.3f} m, {even_signal.mean():.2f}")
    picture.convert("P", palette=Image.ADAPTIVE, colors=16).save(sys.argv[2], optimize=True)


if __name__ == "__main__":
    main()
