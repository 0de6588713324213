#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/allan.png: Allan deviations of the samples of each IMU preset (circles) beside
those of the numbers of its file (lines). It needs the Python package of GLIDAR and matplotlib.

usage: plot_allan.py PICTURE.png
"""

import math
import sys

import glidar
import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

G = 9.80665
DEGREE = math.pi / 180.0
DURATION_S = 3600.0
PRESETS = ("ADIS16448", "BMI088", "ICM-20948")
COLOURS = ("tab:blue", "tab:orange", "tab:green")
PEAK = 0.6173642831443085  # of a correlated process: IEEE Std 952, C.1.1.5


def allan_deviation(values, size):
    """Overlapping Allan deviation of all axes for clusters of `size` samples."""
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    means = (sums[size:] - sums[:-size]) / size
    return math.sqrt(0.5 * np.mean((means[size:] - means[:-size]) ** 2))


def published(keys, names, units, rate_hz, tau_s):
    """White noise, correlated bias, random walk and rounding."""
    ratio = tau_s / keys["correlation_time_s"]
    sigma = keys[names[1]] * units[1] / PEAK
    correlated = sigma**2 * 2.0 / ratio * (1.0 - (3.0 - 4.0 * math.exp(-ratio) + math.exp(-2.0 * ratio)) / (2.0 * ratio))
    white = (keys[names[0]] * units[0]) ** 2 / tau_s
    walk = (keys[names[2]] * units[0]) ** 2 * tau_s / 3.0
    rounding = (keys[names[3]] * units[2]) ** 2 / 12.0 / (tau_s * rate_hz)
    return math.sqrt(white + correlated + walk + rounding)


TRIADS = (
    ("gyroscope", "angular_velocity", "deg/h", DEGREE / 3600.0, (DEGREE, DEGREE / 3600.0, DEGREE),
     ("noise_density_deg_s_sqrt_hz", "bias_instability_deg_h", "random_walk_deg_s2_sqrt_hz", "resolution_deg_s")),
    ("accelerometer", "specific_force", "µg", 1e-6 * G, (1e-6 * G, 1e-6 * G, 1e-3 * G),
     ("noise_density_ug_sqrt_hz", "bias_instability_ug", "random_walk_ug_s_sqrt_hz", "resolution_mg")),
)


def draw(axes, triad, name, colour, samples):
    key, measured, unit, shown, units, names = triad
    imu = glidar.load_imu(name)
    values = getattr(samples, measured)
    sizes = np.unique(np.geomspace(1, len(values) // 9, 28).astype(int))
    taus = sizes / imu.rate_hz
    lines = [published(imu.to_dict()[key], names, units, imu.rate_hz, tau) / shown for tau in taus]
    axes.loglog(taus, lines, color=colour, linewidth=1.2, label=name)
    axes.loglog(taus, [allan_deviation(values, int(size)) / shown for size in sizes], "o", color=colour, markersize=3)
    axes.set_title(key, fontsize=9)
    axes.set_xlabel("averaging time, s", fontsize=8)
    axes.set_ylabel(f"Allan deviation, {unit}", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.grid(which="both", linewidth=0.3)


def main():
    figure, panels = pyplot.subplots(1, 2, figsize=(8.0, 3.2), dpi=100)
    for name, colour in zip(PRESETS, COLOURS):
        samples = glidar.simulate_imu(glidar.load_imu(name), np.eye(4), DURATION_S)
        for axes, triad in zip(panels, TRIADS):
            draw(axes, triad, name, colour, samples)
    panels[0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(sys.argv[1], metadata={"Software": None})


if __name__ == "__main__":
    main()
