# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What each trial of a run of trials measures: pose, seed, scene, sensor, and the values it varies."""

from dataclasses import dataclass

import numpy as np

from glidar.campaign import philox, sampling, variants


@dataclass(frozen=True)
class Trials:
    number: np.ndarray  # N, int64: which trial of the campaign
    seed: np.ndarray  # N, uint64: of the frame's random numbers
    scene: np.ndarray  # N: place in the plan's scenes
    sensor: np.ndarray  # N: place in the plan's sensors
    world_from_sensor: np.ndarray  # N x 4 x 4
    values: dict  # varied path -> N numbers, or N x 4 x 4 poses

    def __len__(self):
        return len(self.number)


def draw_trials(plan, first, count):
    """Trials first .. first + count - 1; each is the same whatever run it is drawn in."""
    spec = plan.spec
    draws = sampling.draw(spec.seed, first, count, spec.trials, spec.method, spec.quantities())

    def of(purpose, spread, *more):
        drawn = draws[purpose]
        return spread.sample(drawn.u, drawn.cell, *more)

    sensor = of("sensor", spec.sensors.spread).astype(np.int64)
    boresight = np.array(plan.boresights)[sensor]
    values = {}
    for variation in spec.vary:
        axes = [np.full(count, "x")] if variation.is_pose else []
        values[variation.path] = of(variation.path, variation.spread, *axes)
    number = np.arange(first, first + count)
    return Trials(number, philox.seeds(spec.seed, number),
                  of("scene", spec.scenes.spread).astype(np.int64), sensor,
                  of("pose", spec.pose, boresight), values)


def changes(plan, trials, row, of):
    """What a trial replaces in its scene ("scene") or sensor file ("sensor"), as variants.replaced
    takes it. Poses are not among them: they are handed over with each measurement."""
    return tuple((v.target, variants.number_text(trials.values[v.path][row]))
                 for v in plan.spec.vary if v.target.of == of and not v.is_pose)


def groups(plan, trials):
    """Trials that measure the same scene with the same sensor: {(scene, sensor, changes of the scene,
    changes of the sensor): rows}."""
    found = {}
    for row in range(len(trials)):
        key = (int(trials.scene[row]), int(trials.sensor[row]),
               changes(plan, trials, row, "scene"), changes(plan, trials, row, "sensor"))
        found.setdefault(key, []).append(row)
    return found
