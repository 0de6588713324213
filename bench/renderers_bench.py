#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The renderers of the processor beside each other, over triangles per beam: where the raster is faster than rays,
and what "auto" selects. They take turns; medians of wall-clock times. --plot draws it."""

import argparse
import os
import sys
import time

try:
    import numpy as np

    import glidar
except ImportError as missing:
    sys.exit(f"{missing}; install GLIDAR (docs/python.md) and what scripts/requirements.txt names")

KINDS = ("rays", "raster", "auto")
SIDES = (32, 48, 64, 80, 96, 128, 256, 512, 1024)
WARM_UP = 4
EXAMPLE = """example:
  PYTHONPATH=build/release/python build/venv/bin/python bench/renderers_bench.py --plot docs/images/raster.png \\
      builtin:asteroid $GLIDAR_DATA/models/stanford/bun_zipper.ply"""


def measure(path, side, rounds):
    """(triangles per beam, {kind: seconds a frame})"""
    scene = glidar.Scene(path)
    low, high = scene.bounds
    middle, size = (low + high) / 2, np.linalg.norm(high - low)
    pose = glidar.look_at(middle + 1.25 * size * np.array([0.3, 0.25, 0.92]), middle, up=(0, 1, 0))
    camera = glidar.camera(side, side, fov_deg=40.0)
    simulators = {kind: glidar.Simulator(scene, camera, renderer=kind) for kind in KINDS}
    times = {kind: [] for kind in KINDS}
    for _ in range(rounds):
        for kind, simulator in simulators.items():
            for frame in range(WARM_UP + 4):  # threads of the renderer before still wait for work
                start = time.perf_counter()
                simulator.simulate(pose)
                if frame >= WARM_UP:
                    times[kind].append(time.perf_counter() - start)
    triangles = sum(len(placed.mesh.triangles) for placed in scene.objects)
    return triangles / side**2, {kind: np.median(values) for kind, values in times.items()}


def plot(found, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4), layout="constrained")
    for name, rows in found.items():
        per_beam = [row[0] for row in rows]
        line, = axes.plot(per_beam, [row[1]["rays"] / row[1]["raster"] for row in rows], "o-", label=f"{name}: raster")
        axes.plot(per_beam, [row[1]["rays"] / row[1]["auto"] for row in rows], "x--", color=line.get_color(),
                  label=f"{name}: auto")
    axes.axhline(1.0, color="grey", linewidth=0.8)
    axes.set(xscale="log", xlabel="triangles per beam", ylabel="time of rays / its own",
             title="A frame with intensity, square pictures of 32 to 1024 pixels")
    axes.legend(fontsize="small")
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, epilog=EXAMPLE,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="+", help="model files")
    parser.add_argument("--rounds", type=int, default=21, help="how often they take turns [21]")
    parser.add_argument("--plot", metavar="PNG", help="where to draw it")
    flags = parser.parse_args()
    found = {}
    for path in flags.models:
        name = os.path.splitext(os.path.basename(path))[0].removeprefix("builtin:")
        rows = found[name] = [measure(path, side, flags.rounds) for side in SIDES]
        for side, (per_beam, seconds) in zip(SIDES, rows):
            words = ", ".join(f"{kind} {1e3 * seconds[kind]:.2f} ms" for kind in KINDS)
            print(f"{name} {side}x{side}, {per_beam:.2g} triangles per beam: {words}; rays / raster "
                  f"{seconds['rays'] / seconds['raster']:.2f}, / auto {seconds['rays'] / seconds['auto']:.2f}",
                  flush=True)
    if flags.plot:
        plot(found, flags.plot)


if __name__ == "__main__":
    main()
