# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The picture of mujoco_rendezvous.py."""

import numpy as np
from matplotlib.figure import Figure


def view(axes, snapshot, model):
    """What the LiDAR sees, coloured by range, over the model where ICP found it."""
    def degrees(points):
        return np.degrees(np.arctan2(points[:, :2].T, points[:, 2]))

    ghost = model @ snapshot.found[:3, :3].T + snapshot.found[:3, 3]
    axes.plot(*degrees(ghost), ",", color="0.85", zorder=2)
    nearest = snapshot.points[:, 2].min()
    axes.scatter(*degrees(snapshot.points), s=1.2, c=snapshot.points[:, 2] - nearest, vmin=0, vmax=6, cmap="viridis",
                 marker="s", linewidths=0, zorder=3)
    for axis, colour in zip(np.eye(3), ("tab:red", "tab:green", "tab:blue")):
        line = snapshot.found[:3, 3] + np.outer([0, 2.2], snapshot.found[:3, :3] @ axis)
        axes.plot(*degrees(line), color=colour, linewidth=1.6, zorder=4)
    axes.set(xlim=(-9.5, 9.5), ylim=(9.5, -9.5), xticks=[], yticks=[], aspect="equal")
    row = snapshot.row
    axes.set_title(f"{row.time_s:.0f} s, {row.range_m:.1f} m away, {row.points} points\n"
                   f"found to {row.translation_mm:.1f} mm and {row.rotation_deg:.2f}°", fontsize=8)


def draw_errors(panels, runs):
    """Translation and rotation over time, the first protocol broad, the second thin over it."""
    protocols = list(dict.fromkeys(protocol for _, protocol in runs))
    colours = {sensor: f"C{k}" for k, sensor in enumerate(dict.fromkeys(sensor for sensor, _ in runs))}
    for (sensor, protocol), frames in runs.items():
        is_first = protocol == protocols[0]
        style = {"color": colours[sensor], "alpha": 0.45 if is_first else 1.0, "linewidth": 3 if is_first else 0.7,
                 "label": f"{sensor}, {protocol}"}
        rows = [frame.row for frame in frames]
        panels[0].semilogy([row.time_s for row in rows], [row.translation_mm for row in rows], **style)
        panels[1].semilogy([row.time_s for row in rows], [row.rotation_deg for row in rows], **style)
    for panel, label in zip(panels, ("error of position, mm", "error of attitude, degrees")):
        panel.set_title(label, fontsize=9)
        panel.set(xlabel="time, s", xlim=(0, rows[-1].time_s))
        panel.grid(alpha=0.3)
    panels[1].legend(fontsize=8, ncols=2)


def draw(runs, model, path):
    """Four frames of the first run, and the errors of all; `model`: points of its surface."""
    figure = Figure(figsize=(9.6, 5.6), dpi=100, layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=[1.25, 1])
    frames = next(iter(runs.values()))
    for panel, part in zip(above.subplots(1, 4), (0, 1 / 3, 2 / 3, 1)):
        view(panel, frames[round(part * (len(frames) - 1))], model)
    draw_errors(below.subplots(1, 2), runs)
    figure.savefig(path)
