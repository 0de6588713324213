# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The parameters of trials: pose, seed, scene, sensor and varied values."""

from dataclasses import dataclass

import numpy as np

from glidar.campaign import philox, sampling, variants


@dataclass(frozen=True)
class Trials:
    number: np.ndarray  # N, int64: number of the trial in the campaign
    seed: np.ndarray  # N, uint64: of the frame's random numbers
    scene: np.ndarray  # N: index in the plan's scenes
    sensor: np.ndarray  # N: index in the plan's sensors
    world_from_sensor: np.ndarray  # N x 4 x 4
    values: dict  # varied path -> N numbers, or N x 4 x 4 poses

    def __len__(self):
        return len(self.number)


def draw_trials(plan, first, count):
    """Trials first .. first + count - 1; a trial does not depend on the others."""
    spec = plan.spec
    draws = sampling.draw(spec.seed, first, count, spec.trials, spec.method, spec.quantities())

    def of(purpose, distribution, *more):
        samples = draws[purpose]
        return distribution.sample(samples.u, samples.cell, *more)

    sensor = of("sensor", spec.sensors.distribution).astype(np.int64)
    boresight = np.array(plan.boresights)[sensor]
    values = {}
    for variation in spec.vary:
        axes = [np.full(count, "x")] if variation.is_pose else []
        values[variation.path] = of(variation.path, variation.distribution, *axes)
    number = np.arange(first, first + count)
    return Trials(number, philox.seeds(spec.seed, number),
                  of("scene", spec.scenes.distribution).astype(np.int64), sensor,
                  of("pose", spec.pose, boresight), values)


def changes(plan, trials, row, of):
    """The values that a trial replaces in its scene ("scene") or sensor file ("sensor"), for variants.replaced.
    Poses are excluded, because they are arguments of the measurement."""
    return tuple((v.target, variants.number_text(trials.values[v.path][row]))
                 for v in plan.spec.vary if v.target.of == of and not v.is_pose)


def groups(plan, trials):
    """Groups trials with the same scene and sensor: {(scene, sensor, changes of the scene,
    changes of the sensor): rows}."""
    found = {}
    for row in range(len(trials)):
        key = (int(trials.scene[row]), int(trials.sensor[row]),
               changes(plan, trials, row, "scene"), changes(plan, trials, row, "sensor"))
        found.setdefault(key, []).append(row)
    return found
