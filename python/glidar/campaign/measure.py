# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Measures trials. Trials with the same scene and sensor are measured together."""

from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property

import numpy as np

import glidar
from glidar import Error
from glidar.campaign import inputs, loading
from glidar.campaign.poses import require_finite
from glidar.campaign.trials import changes, groups

BATCH_BEAMS = 1 << 19  # per batch
MAX_CACHED = 8  # scenes, and sensors, that stay loaded
HIDDEN_DISTANCE = 10.0  # distance of hidden objects behind the camera, in sizes of the scene


@dataclass
class TrialSetup:
    """A scene, a sensor and their simulator."""

    scene: object
    sensor: object
    simulator: object
    scene_index: int  # index in the plan
    threads: int

    @cached_property
    def intrinsics(self):
        return loading.intrinsics_of(self.sensor, self.sensor.name)

    @cached_property
    def canvas(self):
        """A simulator for silhouettes on a larger image, in which truncated objects are complete. With the same number
        of threads it shares the simulator's tree."""
        camera = loading.canvas_camera(self.sensor, self.intrinsics)
        return glidar.Simulator(self.scene, camera, threads=self.threads)

    @cached_property
    def size_m(self):
        minimum, maximum = self.scene.bounds
        return float(np.linalg.norm(maximum - minimum)) + float(np.abs([minimum, maximum]).max())


class MeasuredTrial:
    """A frame with everything that outputs need."""

    def __init__(self, frame, setup):
        self._frame, self._setup = frame, setup
        self.scene = setup.scene_index
        self.status, self.range_m, self.intensity = frame.status, frame.range_m, frame.intensity
        self.world_from_sensor = frame.world_from_sensor
        self.world_from_objects = frame.world_from_objects

    def columns(self, names):
        cloud = self._frame.cloud(names)
        return {name: cloud[name] for name in names}

    def save(self, path, columns):
        self._frame.save(path, columns=columns, sidecar=False)

    @property
    def depth_m(self):
        return self.columns(("depth",))["depth"]

    @property
    def instance(self):
        return self._frame.ground_truth.instance

    @property
    def intrinsics(self):
        return self._setup.intrinsics

    def boxes(self):
        """A box for each object that has triangles, whether it has a class or not."""
        return self._frame.boxes(unlabelled=True)

    def silhouettes(self):
        """A mask per object: the pixels of the canvas that would hit it if it were alone. All other objects are moved
        behind the camera, where no beam hits them."""
        away = np.eye(4)
        away[:3, 3] = (self.world_from_sensor[:3, 3] - HIDDEN_DISTANCE * self._setup.size_m
                       * self.world_from_sensor[:3, 2])
        masks = []
        for i, own in enumerate(self.world_from_objects):
            poses = np.tile(away, (len(self.world_from_objects), 1, 1))
            poses[i] = own
            alone = self._setup.canvas.simulate(self.world_from_sensor, objects=poses,
                                                columns=["instance"])
            masks.append(alone.ground_truth.instance == i)
        return masks


def columns_of(outputs):
    """The columns that the outputs of a campaign need, including glidar's defaults."""
    names = ["range"] + (["depth", "instance"] if outputs.bop else [])
    names += ["xyz", "intensity", "range", "instance", "class"] if outputs.kitti else []
    names += outputs.npz.columns if outputs.npz else []
    names += ["depth"] if outputs.exr else []
    if outputs.mcap:
        names += ["xyz", "depth", *(outputs.mcap.columns or ["intensity", "range", "instance", "class"])]
    for cloud in (outputs.pcd, outputs.ply, outputs.exr):
        if cloud:
            names += cloud.columns or ["xyz", "intensity", "range", "normal", "instance", "class"]
    return list(dict.fromkeys(names))


class Measurer:
    """Loads scenes and sensors when trials need them, and measures. `threads` 0: one per core."""

    def __init__(self, plan, threads):
        self._plan, self._threads = plan, threads
        self._columns = columns_of(plan.spec.outputs)
        self._scenes, self._sensors = OrderedDict(), OrderedDict()
        self._folder = f"{plan.spec.file.resolve().parent}/"

    def measure(self, trials):
        """Yields (rows, frames, "") or (rows, None, error), until every trial was yielded once."""
        for key, rows in groups(self._plan, trials).items():
            try:
                setup = self._setup(key)
            except inputs.InputChanged:
                raise
            except Error as error:
                yield rows, None, self._text(error)
                continue
            step = max(1, BATCH_BEAMS // max(1, setup.sensor.rows * setup.sensor.cols))
            for first in range(0, len(rows), step):
                yield from self._measure_rows(setup, trials, rows[first : first + step])

    def _measure_rows(self, setup, trials, rows):
        try:
            yield rows, self._frames(setup, trials, rows), ""
        except Error as error:
            if len(rows) == 1:
                yield rows, None, self._text(error)
                return
            for row in rows:  # find the trial that fails
                yield from self._measure_rows(setup, trials, [row])

    def _frames(self, setup, trials, rows):
        require_finite(trials.world_from_sensor[rows], "pose")
        objects = self._objects(setup, trials, rows)
        frames = setup.simulator.simulate_batch(trials.world_from_sensor[rows], trials.seed[rows],
                                                objects=objects, columns=self._columns)
        return [MeasuredTrial(frame, setup) for frame in frames]

    def _objects(self, setup, trials, rows):
        """Poses of all objects for each trial when the campaign varies some; else None."""
        varied = [v for v in self._plan.spec.vary if v.is_pose]
        if not varied:
            return None
        fixed = np.array([instance.pose for instance in setup.scene.objects])
        poses = np.tile(fixed, (len(rows), 1, 1, 1))
        for variation in varied:
            sampled = trials.values[variation.path][rows]
            require_finite(sampled, f"vary.{variation.path}")
            poses[:, _object_index(setup.scene, variation.target)] = sampled
        return poses

    def _setup(self, key):
        scene_index, sensor_index, scene_changes, sensor_changes = key
        scene = _cached(self._scenes, (scene_index, scene_changes), loading.load_scene,
                      self._plan.scenes[scene_index], scene_changes)
        sensor = _cached(self._sensors, (sensor_index, sensor_changes), loading.load_sensor,
                       self._plan.sensors[sensor_index], sensor_changes)
        simulator = glidar.Simulator(scene, sensor, threads=self._threads)
        return TrialSetup(scene, sensor, simulator, scene_index, self._threads)

    def _text(self, error):
        """The error without the path of the campaign's folder, which depends on the machine."""
        return str(error).replace(self._folder, "")


def _cached(known, key, load, source, changes):
    """The value from a cache of the most recently used ones, or a newly loaded value."""
    if key not in known:
        known[key] = inputs.load(source, load, changes)
    known.move_to_end(key)
    while len(known) > MAX_CACHED:
        known.popitem(last=False)
    return known[key]


def _object_index(scene, target):
    """The index of the object that scene.models[NAME or i].pose refers to."""
    word = target.steps[1][1:-1]
    return int(word) if word.isdecimal() else scene[word].index
