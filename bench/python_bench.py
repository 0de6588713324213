#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What Python adds to the time of a measurement, against the same loop in C++.

usage: PYTHONPATH=build/dev/python build/venv/bin/python bench/python_bench.py BASELINE MODEL [ROUNDS]
BASELINE is build/dev/bench/baseline/python_baseline. Both sides measure in turn, with one thread; times are
of the processor, ratios of medians.
"""

import statistics
import subprocess
import sys
import time

import numpy as np

import glidar

FRAMES = 100


def poses_about(scene):
    low, high = scene.bounds
    middle, distance = (low + high) / 2, 3.0 * np.linalg.norm(high - low)
    angles = 2 * np.pi * np.arange(FRAMES) / FRAMES
    eyes = middle + distance * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    return np.stack([glidar.look_at(eye, middle) for eye in eyes])


class Baseline:
    def __init__(self, program, model):
        self.process = subprocess.Popen([program, model], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def seconds(self, word):
        self.process.stdin.write(f"{word}\n")
        self.process.stdin.flush()
        return float(self.process.stdout.readline())


def seconds(work):
    start = time.process_time()
    work()
    return time.process_time() - start


def compare(name, baseline, word, work, rounds):
    """Prints the medians of both and their ratio; they take turns."""
    for _ in range(3):
        baseline.seconds(word)
        work()
    pairs = [(baseline.seconds(word), seconds(work)) for _ in range(rounds)]
    cpp, python = (statistics.median(times) for times in zip(*pairs, strict=True))
    print(f"{name:<34} C++ {1e3 * cpp:9.3f} ms   Python {1e3 * python:9.3f} ms   ratio {python / cpp:.3f}", flush=True)


def main():
    program, model = sys.argv[1:3]
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 200
    baseline = Baseline(program, model)
    scene = glidar.Scene(model)
    sensor = glidar.camera(256, 256, fov_deg=20.0)
    poses = poses_about(scene)
    simulator = scene.simulator(sensor, threads=1)
    compare("a frame, Simulator.simulate", baseline, "frame", lambda: simulator.simulate(poses[0]), 5 * rounds)
    compare("a frame, glidar.simulate", baseline, "frame", lambda: glidar.simulate(scene, sensor, poses[0], threads=1), 5 * rounds)
    compare(
        f"{FRAMES} frames, glidar.simulate_batch",
        baseline,
        "batch",
        lambda: glidar.simulate_batch(scene, sensor, poses, np.arange(FRAMES), threads=1),
        max(10, rounds // 10),
    )


if __name__ == "__main__":
    main()
