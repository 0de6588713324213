#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A campaign's speed against the bare measurement of the same trials: simulate_batch with the same
poses, seeds and columns, in batches of the same size, without writing. Both take turns, since machines
are noisy. With --sync: what the campaign's --durable costs, against the same campaign without, and the time that fsync
takes in the thread that writes, which measuring does not wait for unless it is the slower one.

usage: campaign_bench.py [--trials 10000] [--size 128] [--turns 5] [--workers N] [--scene SCENE.yaml]
                         [--outputs YAML] [--folder DIR] [--sync]
"""

import argparse
import os
import resource
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

import glidar
from glidar.campaign import local, measure, plan as plans, run, spec
from glidar.campaign.trials import draw_trials

SCENE = "models: [{name: rock, model: 'builtin:asteroid'}]\n"
SENSOR = """optics: {{type: pinhole, width: {size}, height: {size}, fov_deg: 30}}
noise: [{{type: range_gaussian, sigma_m: 0.01}}]
"""
CAMPAIGN = """scene: {scene}
sensor: sensor.yaml
trials: {trials}
pose:
  position: {{shell: {{radius_m: [3, 5]}}}}
  orientation: {{look_at: {{max_offset_deg: 3, roll_deg: {{uniform: [-180, 180]}}}}}}
outputs: {outputs}
"""


def clock():
    """Wall-clock and processor time in seconds."""
    return np.array([time.perf_counter(), time.process_time()])


def bare_seconds(plan, simulator):
    """The measurement of all trials, and nothing else."""
    columns = measure.columns_of(plan.spec.outputs)
    step = max(1, measure.BATCH_BEAMS // (simulator.sensor.rows * simulator.sensor.cols))
    seconds = np.zeros(2)
    for shard in range(plan.shards):
        trials = draw_trials(plan, *plan.trials_of(shard))
        start = clock()
        for first in range(0, len(trials), step):
            part = slice(first, first + step)
            simulator.simulate_batch(trials.world_from_sensor[part], trials.seed[part],
                                     columns=columns)
        seconds += clock() - start
    return seconds


def campaign_seconds(path, workers, durable=False):
    """The whole campaign: drawing, measuring, writing, index and manifest."""
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        start = clock()
        outcome = run.run(path, Path(folder) / "out", workers=workers, quiet=True, durable=durable)
        seconds = clock() - start
    assert outcome.failed == 0
    return seconds


class SyncClock:
    """Counts calls of os.fsync, and the time during which one thread or more waits for it."""

    def __init__(self):
        self.seconds, self.calls, self._sync = 0.0, 0, os.fsync
        self._waiting, self._since, self._lock = 0, 0.0, threading.Lock()

    def _note(self, change):
        with self._lock:
            now = time.perf_counter()
            self.seconds += now - self._since if self._waiting else 0.0
            self._waiting, self._since = self._waiting + change, now

    def __enter__(self):
        def sync(descriptor):
            self._note(1)
            self._sync(descriptor)
            self._note(-1)
            self.calls += 1

        os.fsync = sync
        return self

    def __exit__(self, *_):
        os.fsync = self._sync


def compare_syncs(path, flags):
    """Campaigns with and without sync in turns; prints the ratio of their times, and the share of fsync."""
    rows = []
    campaign_seconds(path, flags.workers)  # once, so that all is loaded
    for turn in range(flags.turns):
        seconds = {}
        for durable in (turn % 2 == 0, turn % 2 == 1):
            with SyncClock() as clock_of_syncs:
                seconds[durable] = campaign_seconds(path, flags.workers, durable)[0]
            if durable:
                syncs = clock_of_syncs
        rows.append((seconds[True] / seconds[False], syncs.seconds / seconds[True], seconds[False]))
        print(f"turn {turn}: {seconds[False]:.2f} s, durable {seconds[True]:.2f} s, of it fsync {syncs.seconds:.2f} s in "
              f"{syncs.calls} calls", flush=True)
    ratio, share, plain = np.median(rows, axis=0)
    low, high = np.percentile([row[0] for row in rows], [25, 75])
    noise = np.percentile([row[2] for row in rows], 75) / np.percentile([row[2] for row in rows], 25)
    print(f"{flags.trials} frames of {flags.size}x{flags.size}, outputs {flags.outputs}: durable takes {ratio:.3f} of the time "
          f"without (quartiles {low:.3f} to {high:.3f}), fsync {100 * share:.1f} % of the time; without, quartiles differ "
          f"by a factor of {noise:.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--trials", type=int, default=10_000)
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--workers", type=int, default=0)
    parser.add_argument("--scene", default="")
    parser.add_argument("--outputs", default="{npz: true}")
    parser.add_argument("--folder", help="where the campaign is written [a temporary folder]")
    parser.add_argument("--sync", action="store_true", help="measure --durable instead")
    flags = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=flags.folder) as folder:
        folder = Path(folder)
        scene = Path(flags.scene).resolve() if flags.scene else folder / "scene.yaml"
        if not flags.scene:
            scene.write_text(SCENE)
        (folder / "sensor.yaml").write_text(SENSOR.format(size=flags.size))
        path = folder / "campaign.yaml"
        path.write_text(CAMPAIGN.format(scene=scene, trials=flags.trials, outputs=flags.outputs))
        if flags.sync:
            compare_syncs(path, flags)
            return
        plan = plans.make_plan(spec.read_spec(path))
        simulator = glidar.Simulator(glidar.load_scene(scene),
                                     glidar.load_sensor(folder / "sensor.yaml"))
        ratios = []
        for turn in range(flags.turns):
            bare = bare_seconds(plan, simulator)
            whole = campaign_seconds(path, flags.workers)
            ratios.append(bare / whole)
            print(f"turn {turn}: bare {flags.trials / bare[0]:.0f} frames/s, campaign "
                  f"{flags.trials / whole[0]:.0f} frames/s, ratio {ratios[-1][0]:.2f}, of processor "
                  f"time {ratios[-1][1]:.2f}", flush=True)
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(f"{flags.trials} frames of {flags.size}x{flags.size}, {local.cores()} cores, "
              f"{flags.workers or 'usual'} workers: median ratio {np.median(ratios, axis=0)[0]:.2f} "
              f"(goal 0.85), of processor time {np.median(ratios, axis=0)[1]:.2f}, peak memory {memory:.0f} MiB")


if __name__ == "__main__":
    main()
