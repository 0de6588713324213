# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The picture of examples/icp_monte_carlo.py: maps of convergence, errors against the bound, causes of failure."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

METHODS = ("small_gicp plane", "small_gicp GICP", "Open3D plane")
AGAINST_BOUND = (("Open3D plane", "tab:blue"), ("weighted", "tab:orange"), ("planes known", "tab:green"))
CAUSES = (("local minimum", "tab:red"), ("fits as well", "tab:purple"), ("out of reach", "tab:grey"))


def chosen(rows, **keys):
    return [row for row in rows if all(getattr(row, key) == value for key, value in keys.items())]


def draw_map(panel, rows, title):
    """Fraction converged of the noisy clouds, by the start."""
    rotations, shifts = (sorted({getattr(row, key) for row in rows}) for key in ("rotation_deg", "shift"))
    fractions = np.full((len(rotations), len(shifts)), np.nan)
    for i, rotation in enumerate(rotations):
        for j, shift in enumerate(shifts):
            cell = chosen(rows, rotation_deg=rotation, shift=shift)
            if cell:
                fractions[i, j] = np.mean([row.outcome == "converged" for row in cell])
                panel.text(j, i, f"{100 * fractions[i, j]:.0f}", ha="center", va="center", fontsize=7,
                           color="white" if fractions[i, j] < 0.6 else "black")
    panel.imshow(fractions, origin="lower", vmin=0, vmax=1, cmap="viridis", aspect="auto")
    panel.set_xticks(range(len(shifts)), [f"{shift:g}" for shift in shifts], fontsize=7)
    panel.set_yticks(range(len(rotations)), [f"{rotation:g}" for rotation in rotations], fontsize=7)
    panel.set_title(title, fontsize=8.5)
    panel.set_xlabel("start shifted by, radii", fontsize=8)


def draw_bound(panel, rows, name):
    """Errors of noisy, converged runs against the bound of their views."""
    for method, colour in AGAINST_BOUND:
        good = chosen(rows, method=method, cloud="noisy", outcome="converged")
        if not good:
            continue
        bound, error = (np.array([1e3 * getattr(row, key) for row in good]) for key in ("bound_m", "error_m"))
        panel.loglog(bound, error, ".", color=colour, markersize=2.5, alpha=0.6,
                     label=f"{method}, rms {np.sqrt((np.minimum(error / bound, 100) ** 2).mean()):.2f} of the bound")
    low, high = (1e3 * pick([row.bound_m for row in rows]) for pick in (min, max))
    panel.plot([low, high], [low, high], "k-", linewidth=1)
    panel.set_ylim(top=6 * panel.get_ylim()[1])  # the legend's place
    for axis in (panel.xaxis, panel.yaxis):
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())
    ticks = [value for value in (0.1, 0.2, 0.3, 0.5, 1, 2, 3, 5, 10, 20) if low <= value <= high]
    panel.set_xticks(ticks, [f"{value:g}" for value in ticks])
    panel.set_xlabel("Cramer-Rao bound of the view, mm", fontsize=8)
    panel.set_ylabel("error, mm", fontsize=8)
    panel.set_title(f"{name}: errors, and the bound as a line", fontsize=8.5)
    panel.legend(fontsize=6.5, loc="upper left", markerscale=3)
    panel.tick_params(labelsize=7)


def draw_causes(panel, rows, name):
    """What becomes of noisy clouds, by how far the start is turned."""
    rotations = sorted({row.rotation_deg for row in rows})
    for k, method in enumerate(METHODS):
        below = np.zeros(len(rotations))
        for cause, colour in CAUSES:
            shares = [100 * np.mean([row.outcome == cause for row in chosen(rows, method=method, rotation_deg=rotation)])
                      for rotation in rotations]
            panel.bar(np.arange(len(rotations)) + 0.27 * (k - 1), shares, 0.25, bottom=below, color=colour,
                      label=cause if k == 0 else None, alpha=1 - 0.25 * k)
            below += shares
    panel.set_xticks(range(len(rotations)), [f"{rotation:g}" for rotation in rotations], fontsize=7)
    panel.set_xlabel("start turned by, degrees", fontsize=8)
    panel.set_ylabel("% of runs", fontsize=8)
    panel.set_title(f"{name}: why runs fail", fontsize=8.5)
    panel.set_ylim(0, 150)
    panel.set_yticks(range(0, 101, 25))
    panel.text(0.98, 0.98, "bars, left to right:\n" + "\n".join(METHODS), transform=panel.transAxes, fontsize=6.5,
               va="top", ha="right")
    panel.legend(fontsize=6.5, loc="upper left")
    panel.tick_params(labelsize=7)


def draw(rows, path):
    """One row of panels per target."""
    names = list(dict.fromkeys(row.target for row in rows))
    figure = Figure(figsize=(12.5, 2.9 * len(names)), dpi=100, layout="constrained")
    grid = figure.subplots(len(names), 5, squeeze=False, width_ratios=[1, 1, 1, 1.35, 1.2])
    for panels, name in zip(grid, names, strict=True):
        of = chosen(rows, target=name)
        noisy = chosen(of, cloud="noisy")
        for panel, method in zip(panels, METHODS, strict=False):
            draw_map(panel, chosen(noisy, method=method), f"{method}: converged, %")
        panels[0].set_ylabel(f"{name}: start turned by, degrees", fontsize=8)
        draw_bound(panels[3], of, name)
        draw_causes(panels[4], noisy, name)
    figure.savefig(path)
