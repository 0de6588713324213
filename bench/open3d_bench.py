#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Frames of a pinhole camera: GLIDAR's measurement against Open3D's RaycastingScene with the creation of its rays.

Both are made ready before, see the same mesh from the same pose with two threads, and take turns. Depths are compared
first. Times are of the clock, medians and ratios of medians; with --processor those of the processor, for machines
that are busy with other work.
"""

import argparse
import os
import sys
import time

try:
    import numpy as np
    import open3d

    import glidar
except ImportError as missing:
    sys.exit(f"{missing}; install GLIDAR (docs/python.md) and what scripts/requirements.txt names")

THREADS = 2
DISTANCE = 1.25  # of the camera, in diagonals of the model's box
SIZES = ((640, 480), (1024, 1024))
EXAMPLE = """example:
  PYTHONPATH=build/release/python build/venv/bin/python bench/open3d_bench.py \\
      $GLIDAR_DATA/models/stanford/bun_zipper.ply"""


class Views:
    """One mesh in both programs, seen by one camera."""

    def __init__(self, path, width, height, distance=DISTANCE):
        scene = glidar.Scene(path)
        mesh = scene.objects[0].mesh
        self.sensor = glidar.camera(width, height, fov_deg=40.0)
        low, high = scene.bounds
        middle, size = (low + high) / 2, np.linalg.norm(high - low)
        self.pose = glidar.look_at(middle + distance * size * np.array([0.3, 0.25, 0.92]), middle, up=(0, 1, 0))
        self.simulator = glidar.Simulator(scene, self.sensor, threads=THREADS)
        self.other = open3d.t.geometry.RaycastingScene(nthreads=THREADS)
        self.other.add_triangles(open3d.core.Tensor(mesh.vertices.astype(np.float32)), open3d.core.Tensor(mesh.triangles))
        optics = self.sensor.describe()["optics"]
        self.intrinsics = np.array([[optics["fx"], 0, optics["cx"]], [0, optics["fy"], optics["cy"]], [0, 0, 1]])
        self.extrinsics = np.linalg.inv(self.pose)
        self.width, self.height = width, height

    def glidar(self):
        return self.simulator.simulate(self.pose)

    def glidar_ranges(self):
        return self.simulator.simulate(self.pose, columns=["range"])

    def rays(self):
        return self.other.create_rays_pinhole(self.intrinsics, self.extrinsics, self.width, self.height)

    def open3d(self):
        return self.other.cast_rays(self.rays(), nthreads=THREADS)

    def compare(self):
        """Largest difference of depths where both hit, m, and pixels in which only one does."""
        depth = self.glidar().cloud(["depth"])["depth"]
        theirs = self.open3d()["t_hit"].numpy().astype(float)  # their rays have 1 along the boresight: t is the depth
        both = np.isfinite(depth) & np.isfinite(theirs)
        return np.abs(depth[both] - theirs[both]), int((np.isfinite(depth) != np.isfinite(theirs)).sum()), int(both.sum())


def seconds(work, clock):
    start = clock()
    work()
    return clock() - start


def measure(views, rounds, clock):
    """Times (rounds, 4) of Open3D, its creation of rays alone, GLIDAR's usual frame, and GLIDAR's ranges alone."""
    works = (views.open3d, views.rays, views.glidar, views.glidar_ranges)
    for work in works * 3:
        work()
    return 1e3 * np.array([[seconds(work, clock) for work in works] for _ in range(rounds)])


def main():
    parser = argparse.ArgumentParser(description=__doc__, epilog=EXAMPLE,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="+", help="model files")
    parser.add_argument("--rounds", type=int, default=41, help="how often they take turns [41]")
    parser.add_argument("--processor", action="store_true", help="time of the processor in place of the clock's")
    parser.add_argument("--distance", type=float, default=DISTANCE,
                        help="of the camera, in diagonals of the model's box [%(default)s]")
    flags = parser.parse_args()
    clock = time.process_time if flags.processor else time.perf_counter
    for path in flags.models:
        for width, height in SIZES:
            views = Views(path, width, height, flags.distance)
            differences, lonely, hits = views.compare()
            times = measure(views, flags.rounds, clock)
            print(f"{os.path.basename(path)} {width}x{height}: depths differ by {differences.max():.1e} m at most, "
                  f"{np.median(differences):.1e} m in the middle; {lonely} of {hits} hits are of one alone")
            for name, pick in (("median", np.median), ("least", np.min)):
                theirs, rays, ours, ranges = pick(times, axis=0)
                print(f"  {name:<6} Open3D {theirs:7.1f} ms, of it {rays:6.1f} rays; GLIDAR {ours:7.1f} ms, ratio "
                      f"{theirs / ours:.2f}; with ranges alone {ranges:7.1f} ms, ratio {theirs / ranges:.2f}", flush=True)


if __name__ == "__main__":
    main()
