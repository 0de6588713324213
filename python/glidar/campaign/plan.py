# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What a campaign is, apart from where it runs: the spec, the files it reads, the cut into shards.

Its hash is the campaign's identity: two plans with the same hash give the same bytes.
"""

import dataclasses
from dataclasses import dataclass
from pathlib import Path

import glidar
from glidar import Error
from glidar.campaign import files, sensor_files, variants, yaml_file as yf
from glidar.campaign.spec import Spec

FORMAT = 1  # of the campaign folder
SHARD_BEAMS = 1 << 22  # in a shard, where the campaign file does not say how many trials
LEAST_SHARD_TRIALS, LARGEST_SHARD_TRIALS = 16, 1024
PLAN_FILE = "campaign.json"


@dataclass(frozen=True)
class Input:
    """A scene or sensor file: its text once read, or the fault that it has."""

    name: str  # as the campaign file spells it
    path: Path
    text: str = ""
    fault: str = ""  # why its trials fail; empty: nothing is known to be wrong
    files: tuple = ()  # (name as the file spells it, SHA-256) of what it reads


@dataclass(frozen=True)
class Plan:
    spec: Spec
    scenes: tuple  # of Input
    sensors: tuple  # of Input
    boresights: tuple  # per sensor: "x" or "z"
    shard_trials: int

    @property
    def shards(self):
        return -(-self.spec.trials // self.shard_trials)

    def trials_of(self, shard):
        """The trials of a shard: (first, count)."""
        first = shard * self.shard_trials
        return first, min(self.shard_trials, self.spec.trials - first)

    @property
    def one_shape(self):
        """Whether all frames have the same rows and columns."""
        varies = any(v.target.of == "sensor" and v.target.steps[0] in ("optics", "receiver")
                     for v in self.spec.vary)
        return len(self.sensors) == 1 and not varies

    def record(self):
        """All that makes it what it is, as JSON."""
        return {"format": FORMAT, "glidar": glidar.__version__, "campaign": meaning(self.spec),
                "shard_trials": self.shard_trials,
                "scenes": [_input_record(i) for i in self.scenes],
                "sensors": [_input_record(i) for i in self.sensors]}

    def hash(self):
        return files.hash_bytes(files.json_bytes(self.record()))


def meaning(value):
    """A spec as JSON, with the kinds of its distributions and without places of files."""
    if dataclasses.is_dataclass(value):
        fields = {f.name: meaning(getattr(value, f.name)) for f in dataclasses.fields(value)
                  if not isinstance(getattr(value, f.name), Path)}
        return {"kind": type(value).__name__, **fields}
    if isinstance(value, (list, tuple)):
        return [meaning(item) for item in value]
    return value if value is None or isinstance(value, (str, bool, int)) else float(value)


def _input_record(source):
    return {"name": source.name, "sha256": files.hash_bytes(source.text.encode()),
            "fault": bool(source.fault), "files": [list(pair) for pair in source.files]}


def _read_input(name, path):
    """Reads a scene or sensor file; a fault is kept, so that only its trials fail."""
    try:
        text = yf.read_text(path)
        named = variants.files_of(yf.parse(text, path))
        hashes = tuple((field.node.value, files.hash_file(found)) for field, found in named)
        return Input(name, path, text, "", hashes)
    except Error as error:
        return Input(name, path, fault=str(error))


def _require_some(inputs, what):
    if all(i.fault for i in inputs):
        raise Error(what, f"none can be read: {inputs[0].fault}", "at least one that can", "")


def _check_variations(spec, inputs, of):
    """Every value that varies stands in every file that can be read."""
    for source in inputs:
        if source.fault:
            continue
        field = yf.parse(source.text, source.path)
        for variation in spec.vary:
            if variation.target.of == of and not variation.is_pose:
                variants.find(field, variation.target)
            elif variation.target.of == of:
                _check_pose(field, variation)


def _check_pose(field, variation):
    """Poses are set from outside: of a model that is there, in a scene that stands still."""
    steps = variation.target.steps
    if len(steps) != 3 or steps[0] != "models" or steps[2] != "pose":
        raise Error(f"vary.{variation.path}", "no pose of a model", "scene.models[NAME].pose", "")
    variants.find(field, variants.Target("scene", steps[:2]))
    for model in yf.items(yf.need(field, yf.entries(field), "models")):
        moving = {"motion", "trajectory"} & yf.entries(model).keys()
        if moving:
            yf.reject(model, f"it has the key '{moving.pop()}', and vary.{variation.path} sets poses",
                      "models that stand still", "")


def _auto_shard_trials(beams):
    """So many trials that a shard takes tens of megabytes, in powers of two."""
    wanted = max(1, SHARD_BEAMS // max(1, beams))
    trials = 1 << (wanted.bit_length() - 1)
    return min(LARGEST_SHARD_TRIALS, max(LEAST_SHARD_TRIALS, trials))


def make_plan(spec):
    """Reads what the campaign file names and cuts the trials into shards."""
    folder = spec.file.resolve().parent
    scenes = tuple(_read_input(name, folder / name) for name in spec.scenes.names)
    sensors = tuple(_read_input(name, sensor_files.find(name, folder)) for name in spec.sensors.names)
    _require_some(scenes, f"{spec.file}: scene")
    _require_some(sensors, f"{spec.file}: sensor")
    _check_variations(spec, scenes, "scene")
    _check_variations(spec, sensors, "sensor")
    known = [sensor_files.look(s) for s in sensors]
    shard_trials = spec.shard_trials or _auto_shard_trials(max(k.beams for k in known))
    return Plan(spec, scenes, sensors, tuple(k.boresight for k in known), shard_trials)
