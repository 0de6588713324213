# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The plan of a campaign, independent of where it runs: the spec, the hashes of the files that it reads, and the shards.

Its hash identifies the campaign: two plans with the same hash give the same bytes.
"""

import dataclasses
from dataclasses import dataclass
from pathlib import Path

import glidar
from glidar import Error
from glidar.campaign import families, files, inputs, records, sensor_files, variants, yaml_file as yf
from glidar.campaign.spec import Spec

FORMAT = 3  # of the campaign folder
SHARD_BEAMS = 1 << 22  # per shard, when the campaign file does not specify shard_trials
MIN_SHARD_TRIALS, MAX_SHARD_TRIALS = 16, 1024
MAX_SHARDS = records.MAX_SHARDS
PLAN_FILE = "campaign.json"


@dataclass(frozen=True)
class Plan:
    spec: Spec
    scenes: tuple  # of inputs.Input
    sensors: tuple  # of inputs.Input
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
        """Everything that determines the data, as JSON."""
        return {"format": FORMAT, "glidar": glidar.__version__, "campaign": spec_record(self.spec),
                "shard_trials": self.shard_trials,
                "scenes": [i.record() for i in self.scenes],
                "sensors": [i.record() for i in self.sensors]}

    def hash(self):
        return files.hash_bytes(files.json_bytes(identity(self.record())))


def identity(record):
    """The part of a plan's record that identifies the campaign: everything but the name."""
    campaign = {key: value for key, value in record["campaign"].items() if key != "name"}
    return {**record, "campaign": campaign}


def spec_record(value):
    """A spec as JSON, with the types of its distributions and without paths."""
    if dataclasses.is_dataclass(value):
        fields = {f.name: spec_record(getattr(value, f.name)) for f in dataclasses.fields(value)
                  if not isinstance(getattr(value, f.name), Path)}
        return {"kind": type(value).__name__, **fields}
    if isinstance(value, (list, tuple)):
        return [spec_record(item) for item in value]
    return value if value is None or isinstance(value, (str, bool, int)) else float(value)


def _require_some(sources, what):
    if all(source.error for source in sources):
        raise Error(what, f"none can be read: {sources[0].error}", "at least one that can", "")


def _check_variations(spec, sources, of):
    """Checks that every varied value exists in every readable file, and that no two of them overlap."""
    for source in sources:
        if source.error:
            continue
        field = yf.parse(source.text, source.path)
        places = {}
        for variation in [v for v in spec.vary if v.target.of == of]:
            place = _check_pose(field, variation) if variation.is_pose else _check_value(field, variation, source)
            _require_apart(spec, variation.path, place, places)


def _require_apart(spec, path, place, places):
    """Raises Error when a value overlaps one of `places`: {path: location such as "models[0].scale"}."""
    place = place.replace("[", ".[")
    for other, known in places.items():
        if f"{place}.".startswith(f"{known}.") or f"{known}.".startswith(f"{place}."):
            raise Error(f"{spec.file}: vary.{path}", f"it is the same value as vary.{other}, or one contains "
                        "the other", "each value once", f"remove vary.{path} or vary.{other}")
    places[path] = place


def _check_value(field, variation, source):
    """The location of a varied value."""
    layers = families.layers_of(field, source.variant, source.mode) if variation.target.of == "sensor" else ()
    return variants.find(field, variation.target, layers=layers).path


def _check_pose(field, variation):
    """Checks that the pose of an existing model without motion is varied; returns the pose's location."""
    steps = variation.target.steps
    if len(steps) != 3 or steps[0] != "models" or steps[2] != "pose":
        raise Error(f"vary.{variation.path}", "not the pose of a model", "scene.models[NAME].pose", "")
    model = variants.find(field, variants.Target("scene", steps[:2]), is_replaced=False)
    for other in yf.items(yf.need(field, yf.entries(field), "models")):
        moving = {"motion", "trajectory"} & yf.entries(other).keys()
        if moving:
            yf.reject(other, f"it has the key '{moving.pop()}', and vary.{variation.path} sets poses",
                      "models without motion", "")
    return model.path + ".pose"


def _auto_shard_trials(beams):
    """A power of two, such that a shard has tens of megabytes."""
    wanted = max(1, SHARD_BEAMS // max(1, beams))
    trials = 1 << (wanted.bit_length() - 1)
    return min(MAX_SHARD_TRIALS, max(MIN_SHARD_TRIALS, trials))


def _read_sensor(name, spec, loaded):
    try:
        path, variant = sensor_files.find(name, spec.file.resolve().parent)
    except Error as error:
        raise Error(f"{spec.file}: {error.where}", error.found, error.allowed, error.remedy) from None
    return inputs.read(name, path, loaded, variant, spec.mode or "")


def make_plan(spec):
    """Reads the files that the campaign file names, and divides the trials into shards."""
    folder = spec.file.resolve().parent
    loaded = {}
    scenes = tuple(inputs.read(name, folder / name, loaded) for name in spec.scenes.names)
    sensors = tuple(_read_sensor(name, spec, loaded) for name in spec.sensors.names)
    _require_some(scenes, f"{spec.file}: scene")
    _require_some(sensors, f"{spec.file}: sensor")
    _check_variations(spec, scenes, "scene")
    _check_variations(spec, sensors, "sensor")
    known = [sensor_files.properties_of(s) for s in sensors]
    shard_trials = spec.shard_trials or _auto_shard_trials(max(k.beams for k in known))
    if spec.trials > MAX_SHARDS * shard_trials:
        raise Error(f"{spec.file}: shard_trials", f"{spec.trials} trials in shards of {shard_trials}",
                    f"at most {MAX_SHARDS} shards", f"set shard_trials to {-(-spec.trials // MAX_SHARDS)} or more")
    return Plan(spec, scenes, sensors, tuple(k.boresight for k in known), shard_trials)
