# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Measures trials with glidar, those that share scene and sensor together."""

from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property

import numpy as np

import glidar
from glidar import Error
from glidar.campaign import inputs, loading
from glidar.campaign.poses import require_whole
from glidar.campaign.trials import changes, groups

BATCH_BEAMS = 1 << 19  # that are measured together, and handed on to be written
KEPT = 8  # scenes, and sensors, that stay loaded
BEHIND = 10.0  # how far behind the camera others are put aside, in sizes of the scene


@dataclass
class Stage:
    """A scene and a sensor made ready."""

    scene: object
    sensor: object
    simulator: object
    scene_place: int  # in the plan
    threads: int

    @cached_property
    def intrinsics(self):
        return loading.intrinsics_of(self.sensor, self.sensor.name)

    @cached_property
    def canvas(self):
        """What measures silhouettes, with those of truncated objects whole. As it has the simulator's
        threads, it shares its tree."""
        camera = loading.canvas_camera(self.sensor, self.intrinsics)
        return glidar.Simulator(self.scene, camera, threads=self.threads)

    @cached_property
    def size_m(self):
        least, most = self.scene.bounds
        return float(np.linalg.norm(most - least)) + float(np.abs([least, most]).max())


class Measured:
    """A frame with what outputs ask of it."""

    def __init__(self, frame, stage):
        self._frame, self._stage = frame, stage
        self.scene = stage.scene_place
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
        return self._stage.intrinsics

    def silhouettes(self):
        """Of each object where beams of the canvas would meet it if it were alone: all others are put
        behind the camera, where no beam goes."""
        away = np.eye(4)
        away[:3, 3] = (self.world_from_sensor[:3, 3] - BEHIND * self._stage.size_m
                       * self.world_from_sensor[:3, 2])
        masks = []
        for i, own in enumerate(self.world_from_objects):
            poses = np.tile(away, (len(self.world_from_objects), 1, 1))
            poses[i] = own
            alone = self._stage.canvas.simulate(self.world_from_sensor, objects=poses,
                                                columns=["instance"])
            masks.append(alone.ground_truth.instance == i)
        return masks


def columns_of(outputs):
    """The columns that the outputs of a campaign need; "all" where one asks for glidar's usual."""
    names = ["range"] + (["depth", "instance"] if outputs.bop else [])
    names += ["xyz", "intensity", "range", "instance", "class"] if outputs.kitti else []
    names += outputs.npz.columns if outputs.npz else []
    for cloud in (outputs.pcd, outputs.ply):
        if cloud:
            names += cloud.columns or ["xyz", "intensity", "range", "normal", "instance", "class"]
    return list(dict.fromkeys(names))


class Measurer:
    """Makes scenes and sensors ready as trials need them, and measures. `threads` 0: all."""

    def __init__(self, plan, threads):
        self._plan, self._threads = plan, threads
        self._columns = columns_of(plan.spec.outputs)
        self._scenes, self._sensors = OrderedDict(), OrderedDict()
        self._folder = f"{plan.spec.file.resolve().parent}/"

    def measure(self, trials):
        """Yields (rows, frames, ""), or (rows, None, error), until all trials are there once."""
        for key, rows in groups(self._plan, trials).items():
            try:
                stage = self._stage(key)
            except inputs.Changed:
                raise
            except Error as error:
                yield rows, None, self._text(error)
                continue
            step = max(1, BATCH_BEAMS // max(1, stage.sensor.rows * stage.sensor.cols))
            for first in range(0, len(rows), step):
                yield from self._measure_rows(stage, trials, rows[first : first + step])

    def _measure_rows(self, stage, trials, rows):
        try:
            yield rows, self._frames(stage, trials, rows), ""
        except Error as error:
            if len(rows) == 1:
                yield rows, None, self._text(error)
                return
            for row in rows:  # which of them it was
                yield from self._measure_rows(stage, trials, [row])

    def _frames(self, stage, trials, rows):
        require_whole(trials.world_from_sensor[rows], "pose")
        objects = self._objects(stage, trials, rows)
        frames = stage.simulator.simulate_batch(trials.world_from_sensor[rows], trials.seed[rows],
                                                objects=objects, columns=self._columns)
        return [Measured(frame, stage) for frame in frames]

    def _objects(self, stage, trials, rows):
        """Poses of all objects for each trial, where the campaign varies some; else None."""
        varied = [v for v in self._plan.spec.vary if v.is_pose]
        if not varied:
            return None
        standing = np.array([placed.pose for placed in stage.scene.objects])
        poses = np.tile(standing, (len(rows), 1, 1, 1))
        for variation in varied:
            drawn = trials.values[variation.path][rows]
            require_whole(drawn, f"vary.{variation.path}")
            poses[:, _place(stage.scene, variation.target)] = drawn
        return poses

    def _stage(self, key):
        scene_place, sensor_place, scene_changes, sensor_changes = key
        scene = _kept(self._scenes, (scene_place, scene_changes), loading.load_scene,
                      self._plan.scenes[scene_place], scene_changes)
        sensor = _kept(self._sensors, (sensor_place, sensor_changes), loading.load_sensor,
                       self._plan.sensors[sensor_place], sensor_changes)
        simulator = glidar.Simulator(scene, sensor, threads=self._threads)
        return Stage(scene, sensor, simulator, scene_place, self._threads)

    def _text(self, error):
        """What went wrong, without the folder that this machine keeps the campaign in."""
        return str(error).replace(self._folder, "")


def _kept(known, key, load, source, changes):
    """What was loaded before and not long ago, or is loaded now."""
    if key not in known:
        known[key] = inputs.load(source, load, changes)
    known.move_to_end(key)
    while len(known) > KEPT:
        known.popitem(last=False)
    return known[key]


def _place(scene, target):
    """Which object scene.models[NAME or i].pose means."""
    word = target.steps[1][1:-1]
    return int(word) if word.isdecimal() else scene[word].index
