# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The picture of examples/lidar_odometry.py: the street with the trajectories, a wall as it is seen, errors over time."""

import numpy as np
from matplotlib.figure import Figure
from study_tools import aligned, relative_errors

COLOURS = ("tab:red", "tab:orange", "tab:green")


def draw_map(panel, runs, scans):
    """From above: points where they truly are, and the trajectories, aligned."""
    truth = runs[-1]
    for number in range(0, len(scans), 10):
        pose, points = truth.ground_truth[number], scans[number].deskewed[::3]
        world = points @ pose[:3, :3].T + pose[:3, 3]
        world = world[(world[:, 2] > 0.4) & (np.linalg.norm(points, axis=1) < 40)]
        panel.plot(world[:, 0], world[:, 1], ",", color="0.6", rasterized=True)
    panel.plot(*truth.ground_truth[:, :2, 3].T, "k-", linewidth=2.5, label="ground truth")
    for run, colour in zip(runs, COLOURS, strict=True):
        found = aligned(run.poses[:, :3, 3], run.ground_truth[:, :3, 3]) @ run.poses
        panel.plot(*found[:, :2, 3].T, "-", color=colour, linewidth=1, label=run.name)
    low, high = truth.ground_truth[:, :2, 3].min(axis=0) - 18, truth.ground_truth[:, :2, 3].max(axis=0) + 18
    panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel="x, m", ylabel="y, m", aspect="equal")
    panel.legend(fontsize=7, loc="upper left")
    panel.set_title("the street and the trajectories", fontsize=9)


def draw_scan(panel, runs, scans):
    """One turn, as it comes and deskewed, where the turning is quickest."""
    truth = runs[-1].ground_truth
    headings = np.unwrap(np.arctan2(truth[:, 1, 0], truth[:, 0, 0]))
    scan = scans[int(np.abs(np.diff(headings)).argmax())]
    keep = (scan.deskewed[:, 2] > -1.2) & (np.abs(scan.deskewed[:, :2]).max(axis=1) < 25)
    panel.plot(*scan.xyz[keep, :2].T, ".", color="tab:red", markersize=1.5, label="as it comes")
    panel.plot(*scan.deskewed[keep, :2].T, ".", color="tab:green", markersize=1.5, label="deskewed by the ground truth")
    panel.set(xlim=(-25, 25), ylim=(-25, 25), aspect="equal", xlabel="x, m", ylabel="y, m")
    panel.legend(fontsize=7, loc="upper left", markerscale=4)
    panel.set_title("a turn of the sensor, in a bend", fontsize=9)


def draw_errors(upper, lower, runs):
    for run, colour in zip(runs, COLOURS, strict=True):
        upper.plot(run.times_s, 100 * run.errors_m, color=colour, label=f"{run.name}: ATE {100 * run.ate_m():.1f} cm")
        apart = round(1 / (run.times_s[1] - run.times_s[0]))
        metres, _ = relative_errors(run.poses, run.ground_truth, apart)
        lower.plot(run.times_s[apart:], 100 * metres, color=colour, label=f"{run.name}: {run.drift_percent:.2f} % of the way")
    upper.set_title("error of the position, cm", fontsize=9)
    lower.set_title("error of the motion over a second, cm", fontsize=9)
    lower.set_xlabel("time, s", fontsize=8)
    for panel in (upper, lower):
        panel.set_ylim(bottom=0, top=1.35 * panel.get_ylim()[1])
        panel.legend(fontsize=7, loc="upper right")
        panel.grid(alpha=0.3)


def draw(runs, scans, path):
    figure = Figure(figsize=(13, 4.2), dpi=100, layout="constrained")
    panels = figure.subplot_mosaic([["map", "scan", "upper"], ["map", "scan", "lower"]], width_ratios=[1.2, 1, 1.1])
    draw_map(panels["map"], runs, scans)
    draw_scan(panels["scan"], runs, scans)
    draw_errors(panels["upper"], panels["lower"], runs)
    for panel in panels.values():
        panel.tick_params(labelsize=7)
    figure.savefig(path)
