# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The campaign file: trials, varied values and outputs. docs/campaigns/campaign-file.md lists every key."""

import dataclasses
from dataclasses import dataclass
from pathlib import Path

from glidar.campaign import output_spec, sampling, variants, yaml_file as yf
from glidar.campaign.distributions import Choice, Constant, Grid, read_choice, read_distribution
from glidar.campaign.poses import PoseDistribution, read_pose

KEYS = ["name", "seed", "trials", "sampling", "shard_trials", "scene", "sensor", "mode", "pose", "vary",
        "outputs"]
MAX_TRIALS = 1 << 32
MAX_SHARD_TRIALS = 1 << 16


@dataclass(frozen=True)
class Source:
    """The scenes, or the sensors, of the trials."""

    names: tuple  # as in the campaign file
    distribution: object  # Constant, Choice or Grid of their indices


@dataclass(frozen=True)
class Variation:
    """A value of a scene or sensor file that differs between trials."""

    path: str
    target: variants.Target
    distribution: object

    @property
    def is_pose(self):
        return isinstance(self.distribution, PoseDistribution)


@dataclass(frozen=True)
class Spec:
    name: str
    seed: int
    trials: int
    method: str
    shard_trials: int | None  # None: shards of about 32 MB
    scenes: Source
    sensors: Source
    mode: str | None  # of all sensors; None: their default modes
    pose: PoseDistribution
    vary: tuple
    outputs: output_spec.Outputs
    file: Path

    def quantities(self):
        """All random quantities, as (purpose, distribution)."""
        fixed = [("scene", self.scenes.distribution), ("sensor", self.sensors.distribution), ("pose", self.pose)]
        return fixed + [(v.path, v.distribution) for v in self.vary]


def _read_source(field):
    """A name; {choice: [names], weights: [..]}; or {grid: [names]}: one after the other."""
    if yf.is_single(field):
        return Source((yf.name(field),), Constant(0))
    found = yf.entries(field)
    if "grid" in found:
        yf.require_keys(field, ["grid"])
        names = tuple(yf.name(item) for item in yf.items(found["grid"]))
        return Source(names, Grid(tuple(range(len(names)))))
    distribution = read_choice(field, yf.name)
    indices = tuple(range(len(distribution.values)))
    return Source(distribution.values, Choice(indices, distribution.weights))


def _read_vary(field):
    variations = []
    for path, value in yf.entries(field).items():
        target = variants.read_target(value, path)
        if target.steps[-1] == "pose":
            variations.append(Variation(path, target, read_pose(value)))
        else:
            variations.append(Variation(path, target, read_distribution(value)))
    return tuple(variations)


def _read_trials(field, found, spec):
    """The number of trials; default for grids: one pass over all cells."""
    cells = sampling.cells_of(spec.quantities())
    if "trials" in found:
        return yf.whole(found["trials"], 1, MAX_TRIALS)
    if cells == 1:
        yf.reject(field, "the key 'trials' is missing", "a whole number; optional only when the campaign has "
                  "a grid")
    if cells > MAX_TRIALS:
        yf.reject(field, f"the grids have {cells} cells", f"at most {MAX_TRIALS}")
    return cells


def read_spec(path):
    """Reads a campaign file. Every error states file:line:column, the field and what is allowed."""
    field = yf.read_yaml(path)
    found = yf.require_keys(field, KEYS)
    spec = Spec(
        name=yf.optional(found, "name", yf.text, Path(path).stem),
        seed=yf.optional(found, "seed", lambda f: yf.whole(f, 0, (1 << 64) - 1), 0),
        trials=0,
        method=yf.optional(found, "sampling", lambda f: yf.one_of(f, sampling.METHODS), "random"),
        shard_trials=yf.optional(found, "shard_trials",
                                 lambda f: yf.whole(f, 1, MAX_SHARD_TRIALS), None),
        scenes=_read_source(yf.need(field, found, "scene")),
        sensors=_read_source(yf.need(field, found, "sensor")),
        mode=yf.optional(found, "mode", yf.text, None),
        pose=read_pose(yf.need(field, found, "pose")),
        vary=yf.optional(found, "vary", _read_vary, ()),
        outputs=yf.optional(found, "outputs", output_spec.read_outputs, output_spec.DEFAULT),
        file=Path(path),
    )
    trials = _read_trials(field, found, spec)
    if spec.method == "latin_hypercube" and trials > sampling.MAX_STRATA:
        yf.reject(found["sampling"], f"latin_hypercube with {trials} trials",
                  f"at most {sampling.MAX_STRATA} trials", "sobol and random allow more")
    return dataclasses.replace(spec, trials=trials)
