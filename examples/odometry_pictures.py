# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of examples/lidar_odometry.py and examples/odometry_bags.py: trajectories, a revolution of the sensor, errors over time."""

import numpy as np
from matplotlib.figure import Figure
from study_tools import aligned, relative_errors

COLOURS = ("tab:red", "tab:orange", "tab:green")


def draw_points(panel, truth, scans):
    """Points of the street from above, where they truly are."""
    for number in range(0, len(scans), 10):
        pose, points = truth.truth[number], scans[number].deskewed[::3]
        world = points @ pose[:3, :3].T + pose[:3, 3]
        world = world[(world[:, 2] > 0.4) & (np.linalg.norm(points, axis=1) < 40)]
        panel.plot(world[:, 0], world[:, 1], ",", color="0.6", rasterized=True)


def draw_trajectories(panel, runs):
    """The trajectories from above, aligned with the ground truth."""
    truth = runs[-1]
    panel.plot(*truth.truth[:, :2, 3].T, "k-", linewidth=2.5, label="ground truth")
    for run, colour in zip(runs, COLOURS, strict=False):
        found = aligned(run.poses[:, :3, 3], run.truth[:, :3, 3]) @ run.poses
        panel.plot(*found[:, :2, 3].T, "-", color=colour, linewidth=1, label=run.name)
    low, high = truth.truth[:, :2, 3].min(axis=0) - 18, truth.truth[:, :2, 3].max(axis=0) + 18
    panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel="x, m", ylabel="y, m", aspect="equal")
    panel.legend(fontsize=7, loc="upper left")
    panel.set_title("trajectories from above", fontsize=9)


def draw_scan(panel, runs, scans):
    """One turn, as it comes and deskewed, where the turning is quickest."""
    truth = runs[-1].truth
    headings = np.unwrap(np.arctan2(truth[:, 1, 0], truth[:, 0, 0]))
    scan = scans[int(np.abs(np.diff(headings)).argmax())]
    keep = (scan.deskewed[:, 2] > -1.2) & (np.abs(scan.deskewed[:, :2]).max(axis=1) < 25)
    panel.plot(*scan.xyz[keep, :2].T, ".", color="tab:red", markersize=1.5, label="as it comes")
    panel.plot(*scan.deskewed[keep, :2].T, ".", color="tab:green", markersize=1.5, label="deskewed by the ground truth")
    panel.set(xlim=(-25, 25), ylim=(-25, 25), aspect="equal", xlabel="x, m", ylabel="y, m")
    panel.legend(fontsize=7, loc="upper left", markerscale=4)
    panel.set_title("a turn of the sensor, in a bend", fontsize=9)


def draw_errors(upper, lower, runs):
    for run, colour in zip(runs, COLOURS, strict=False):
        upper.plot(run.times_s, 100 * run.errors_m, color=colour, label=f"{run.name}: ATE {100 * run.ate_m():.1f} cm")
        apart = round(1 / (run.times_s[1] - run.times_s[0]))
        metres, _ = relative_errors(run.poses, run.truth, apart)
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
    draw_points(panels["map"], runs[-1], scans)
    draw_trajectories(panels["map"], runs)
    draw_scan(panels["scan"], runs, scans)
    draw_errors(panels["upper"], panels["lower"], runs)
    for panel in panels.values():
        panel.tick_params(labelsize=7)
    figure.savefig(path)


def draw_runs(runs, path):
    """The trajectories and their errors."""
    figure = Figure(figsize=(9.5, 4.2), dpi=100, layout="constrained")
    panels = figure.subplot_mosaic([["map", "upper"], ["map", "lower"]], width_ratios=[1.2, 1.1])
    draw_trajectories(panels["map"], runs)
    draw_errors(panels["upper"], panels["lower"], runs)
    for panel in panels.values():
        panel.tick_params(labelsize=7)
    figure.savefig(path)
