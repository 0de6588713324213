# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""One scene of a nuScenes data set: the frames of all sensors along the trajectory of the rig."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime, timezone
from pathlib import Path

import numpy as np
import numpy.typing as npt

from . import _core
from . import _nuscenes_tables as tables
from ._errors import Error, shown
from ._frame import Frame
from ._inputs import FloatArray
from ._nuscenes_map import GroundMap
from ._nuscenes_tables import Record, token
from ._object_box import ObjectBox
from ._scene import Scene
from ._scene_data import RigSensor
from ._simulator import Simulator
from ._trajectory import Trajectory, first_time_ns

TOP = "LIDAR_TOP"  # the devkit requires it
KEY_PERIOD_NS = 500_000_000  # from one sample to the next: 2 Hz
NS_PER_US = 1000
FIRST_DATE_NS = 315_964_800 * 10**9  # 1980-01-06: later stamps are dates
COLUMNS = ("xyz", "intensity", "range", "ring", "instance", "class")
CAMERA_COLUMNS = ("colour", "incidence")
FULL_INTENSITY = np.float32(255.0)
MAX_LABEL = 255
STEP_S = 0.05  # of the trajectory, for the map's size
GROUND = ("flat.driveable_surface", "flat.sidewalk")


@dataclass
class Channel:
    """A sensor of a scene and its records of sample_data."""

    name: str
    sensor: RigSensor
    simulator: Simulator
    records: list[Record] = field(default_factory=list)

    @property
    def is_camera(self) -> bool:
        return self.sensor.sensor.kind == "camera"

    def frame_count(self, duration_s: float) -> int:
        """Frames that start before a time."""
        return max(1, int(np.ceil(duration_s * self.sensor.sensor.rate_hz - 1e-9)))


def channels_of(scene: Scene, given: Mapping[str, str], renderer: str, threads: int) -> list[Channel]:
    """The sensors of a scene, each with its channel; LIDAR_TOP first, because its frames are the samples."""
    rig = scene.rig
    if not rig:
        raise Error("scene", "it has no sensors", "a scene file with sensors")
    unknown = [name for name in given if name not in rig]
    if unknown:
        raise Error("channels", shown(unknown[0]), f"names of sensors: {' '.join(rig)}")
    found = []
    taken = set(given.values())
    for name, one in rig.items():
        channel = given.get(name) or _channel_name(name, one.sensor.kind == "camera", taken)
        taken.add(channel)
        found.append(Channel(channel, one, Simulator(scene, one.sensor, renderer=renderer, threads=threads)))
    if len({channel.name for channel in found}) < len(found):
        raise Error("channels", "two sensors have the same channel", "a channel for each sensor")
    if TOP not in {channel.name for channel in found if not channel.is_camera}:
        raise Error("scene", "no LiDAR is LIDAR_TOP", "a LiDAR, which the devkit requires", "add a LiDAR to the rig")
    return sorted(found, key=lambda channel: channel.name != TOP)


def _channel_name(name: str, is_camera: bool, taken: set[str]) -> str:
    usual, prefix = ("CAM_FRONT", "CAM_") if is_camera else (TOP, "LIDAR_")
    upper = name.upper().replace("-", "_")
    if upper.startswith(prefix):
        return upper
    return usual if usual not in taken else prefix + upper


@dataclass
class SceneWriter:
    """Writes the files of a scene, and adds its records to the tables."""

    root: Path
    version: str
    name: str
    seed: int
    start_us: int  # of the first frame, unless its stamp is a date that is kept
    keeps_dates: bool
    rig: _core.Trajectories
    categories: Mapping[str, str]  # by the name of a class
    indices: Mapping[str, int]  # of categories in files of lidarseg
    tables: dict[str, list[Record]]
    samples: list[Record] = field(default_factory=list)
    sample_ns: list[int] = field(default_factory=list)
    annotations: dict[int, list[Record]] = field(default_factory=dict)  # by the index of the object
    pixels: dict[str, list[int]] = field(default_factory=dict)  # all and visible ones, by annotation

    def write(self, scene: Scene, channels: list[Channel], duration_s: float) -> None:
        """Measures and writes all frames."""
        self._ego = Trajectory(self.rig)
        self._steps_ns = np.rint(1e9 * np.append(np.arange(0.0, duration_s, STEP_S), duration_s)).astype(np.int64)
        self._category_indices = np.array([self.indices[self.categories[one]] for one in scene.class_names])
        if self._category_indices.max() > MAX_LABEL:
            raise Error("class", f"{self._category_indices.max() + 1} categories", f"up to {MAX_LABEL + 1}, which fit 8 bits")
        for channel in channels:
            self._add_sensor(channel)
            for number in range(channel.frame_count(duration_s)):
                self._add_frame(channel, number)
        self._add_data(channels)
        self._add_annotations()
        self._add_scene(scene)

    def _token(self, *parts: object) -> str:
        """A token of this scene; it depends on the seed, because the data do."""
        return token(self.name, self.seed, *parts)

    def _us(self, stamp_ns: int) -> int:
        return self._offset_us + stamp_ns // NS_PER_US

    def _ego_poses(self, since_start_ns: npt.ArrayLike) -> FloatArray:
        return self._ego.poses_at_ns(first_time_ns(self.rig) + np.asarray(since_start_ns))

    def _begin(self, start_ns: int) -> None:
        """The first frame of LIDAR_TOP states the start."""
        self._start_ns = start_ns
        is_kept = self.keeps_dates and start_ns >= FIRST_DATE_NS
        self._offset_us = 0 if is_kept else self.start_us - start_ns // NS_PER_US
        self._map = GroundMap(self._ego_poses(self._steps_ns)[:, :3, 3])

    def _in_global(self, world_from_body: FloatArray) -> Record:
        pose = world_from_body.copy()
        pose[:3, 3] += self._map.offset_m
        return tables.pose_record(pose)

    def _add_sensor(self, channel: Channel) -> None:
        sensor_token = token("sensor", channel.name)
        if all(record["token"] != sensor_token for record in self.tables["sensor"]):
            modality = "camera" if channel.is_camera else "lidar"
            self.tables["sensor"].append({"token": sensor_token, "channel": channel.name, "modality": modality})
        intrinsics = channel.sensor.sensor.K.tolist() if channel.is_camera else []
        self.tables["calibrated_sensor"].append(
            {"token": self._token("calibrated_sensor", channel.name), "sensor_token": sensor_token,
             **tables.pose_record(channel.sensor.rig_from_sensor), "camera_intrinsic": intrinsics})  # fmt: skip

    def _add_frame(self, channel: Channel, number: int) -> None:
        sensor = channel.sensor
        pose = Trajectory(_core.mounted(self.rig, sensor.rig_from_sensor[None]))
        columns = CAMERA_COLUMNS if channel.is_camera else COLUMNS
        frame = channel.simulator.simulate(pose, seed=self.seed, frame=number, sensor_id=sensor.number, columns=columns)
        if not self.samples:
            self._begin(frame.stamp_ns)
        if channel.name == TOP and frame.stamp_ns - self._start_ns >= len(self.samples) * KEY_PERIOD_NS:
            self._add_sample(frame.stamp_ns)
        sample, is_key = self._sample_of(channel, frame.stamp_ns)
        data = self._data_record(channel, frame, sample, is_key)
        self.tables["ego_pose"].append({"token": data["ego_pose_token"], "timestamp": data["timestamp"],
                                        **self._in_global(self._ego_poses([frame.stamp_ns - self._start_ns])[0])})  # fmt: skip
        if is_key and channel.name == TOP:
            self._annotate(frame, sample)
        if is_key and channel.is_camera:
            self._count_pixels(frame, sample)
        self._save(channel, frame, data)

    def _add_sample(self, stamp_ns: int) -> None:
        self.sample_ns.append(stamp_ns)
        self.samples.append({"token": self._token("sample", len(self.samples)), "timestamp": self._us(stamp_ns),
                             "scene_token": token("scene", self.name)})  # fmt: skip

    def _sample_of(self, channel: Channel, stamp_ns: int) -> tuple[int, bool]:
        """The nearest sample of a frame, and whether it is the sample's key frame: the nearest frame."""
        differences = stamp_ns - np.array(self.sample_ns)
        sample = int(np.abs(differences).argmin())
        if channel.name == TOP:
            return sample, bool(differences[sample] == 0)
        half_ns = 0.5e9 / channel.sensor.sensor.rate_hz
        return sample, bool(-half_ns <= differences[sample] < half_ns)

    def _data_record(self, channel: Channel, frame: Frame, sample: int, is_key: bool) -> Record:
        stamp_us = self._us(frame.stamp_ns)
        own = self._token("sample_data", channel.name, frame.number)
        folder, suffix = "samples" if is_key else "sweeps", "png" if channel.is_camera else "pcd.bin"
        height, width = (frame.rows, frame.cols) if channel.is_camera else (0, 0)
        channel.records.append(
            {"token": own, "sample_token": self.samples[sample]["token"], "ego_pose_token": own,
             "calibrated_sensor_token": self._token("calibrated_sensor", channel.name), "timestamp": stamp_us,
             "fileformat": suffix.split(".")[0], "is_key_frame": is_key, "height": height, "width": width,
             "filename": f"{folder}/{channel.name}/{self.name}__{channel.name}__{stamp_us}.{suffix}"})  # fmt: skip
        return channel.records[-1]

    def _save(self, channel: Channel, frame: Frame, data: Record) -> None:
        path = self.root / data["filename"]
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=self.root) as folder:
            if channel.is_camera:
                image = Path(folder) / "image.rgb.png"
                frame.save(image, sidecar=False)
                image.rename(path)
                return
            scan = Path(folder) / "scan.bin"
            frame.save(scan, sidecar=False, deskew=True)
            points = np.fromfile(scan, "<f4").reshape(-1, 4)
            ring = frame.cloud(["ring"], drop_invalid=True)["ring"].reshape(-1, 1)
            rows = np.concatenate([points[:, :3], FULL_INTENSITY * points[:, 3:], ring.astype("<f4")], axis=1)
            _core.write_file(str(path), rows.astype("<f4").tobytes())
            if data["is_key_frame"] and channel.name == TOP:
                labels = scan.with_suffix(".label")
                classes = np.fromfile(labels, "<u4") & 0xFFFF if labels.exists() else np.zeros(len(points), np.int64)
                self._save_labels(data["token"], self._category_indices[classes])

    def _save_labels(self, data_token: str, indices: FloatArray) -> None:
        """The category of every point."""
        name = f"lidarseg/{self.version}/{data_token}_lidarseg.bin"
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        _core.write_file(str(self.root / name), indices.astype(np.uint8).tobytes())
        self.tables["lidarseg"].append({"token": data_token, "sample_data_token": data_token, "filename": name})

    def _annotate(self, frame: Frame, sample: int) -> None:
        """Boxes of the objects with points, as in nuScenes."""
        for box in frame.boxes(frame="world"):
            category = self.categories[box.class_name]
            if box.points == 0 or category.startswith(tables.UNBOXED):
                continue
            attribute = tables.attribute_of(category, float(np.linalg.norm(box.velocity_m_s)))
            length_m, width_m, height_m = box.size_m
            self.annotations.setdefault(box.index, []).append(
                {"token": self._annotation(sample, box), "sample_token": self.samples[sample]["token"],
                 "instance_token": self._token("instance", box.index),
                 "visibility_token": tables.visibility_token(box.visible_beams, box.beams),
                 "attribute_tokens": [token("attribute", attribute)] if attribute else [],
                 **self._in_global(box.frame_from_box), "size": tables.plain([width_m, length_m, height_m]),
                 "num_lidar_pts": box.points, "num_radar_pts": 0, "category": category})  # fmt: skip

    def _annotation(self, sample: int, box: ObjectBox) -> str:
        return self._token("sample_annotation", sample, box.index)

    def _count_pixels(self, frame: Frame, sample: int) -> None:
        """Of scenes with cameras, visibility is a fraction of the pixels of all images, as in nuScenes."""
        for box in frame.boxes():
            counts = self.pixels.setdefault(self._annotation(sample, box), [0, 0])
            counts[0] += box.beams
            counts[1] += box.visible_beams

    def _add_data(self, channels: list[Channel]) -> None:
        tables.link(self.samples)
        self.tables["sample"] += self.samples
        for channel in channels:
            tables.link(channel.records)
            self.tables["sample_data"] += channel.records

    def _add_annotations(self) -> None:
        for index, records in sorted(self.annotations.items()):
            category = [record.pop("category") for record in records][0]
            for record in records:
                pixels, visible = self.pixels.get(record["token"], (0, 0))
                if pixels:
                    record["visibility_token"] = tables.visibility_token(visible, pixels)
            tables.link(records)
            self.tables["sample_annotation"] += records
            self.tables["instance"].append(
                {"token": self._token("instance", index), "category_token": token("category", category),
                 "nbr_annotations": len(records), "first_annotation_token": records[0]["token"],
                 "last_annotation_token": records[-1]["token"]})  # fmt: skip

    def _add_scene(self, scene: Scene) -> None:
        log, image = token("log", self.name), f"maps/{token('map', self.name)}.png"
        offset = ", ".join(f"{one:g}" for one in self._map.offset_m)
        start = datetime.fromtimestamp(self.samples[0]["timestamp"] / 1e6, timezone.utc)
        self.tables["log"].append({"token": log, "logfile": self.name, "vehicle": "glidar",
                                   "date_captured": start.strftime("%Y-%m-%d"), "location": self.name})  # fmt: skip
        self.tables["scene"].append(
            {"token": token("scene", self.name), "log_token": log, "nbr_samples": len(self.samples),
             "first_sample_token": self.samples[0]["token"], "last_sample_token": self.samples[-1]["token"],
             "name": self.name, "description": f"global coordinates are those of the scene file plus ({offset}) m"})  # fmt: skip
        self.tables["map"].append({"token": token("map", self.name), "log_tokens": [log], "category": "semantic_prior",
                                   "filename": image})  # fmt: skip
        ground = [one for one in scene.objects if self.categories[one.class_name] in GROUND]
        (self.root / "maps").mkdir(exist_ok=True)
        self._map.image(ground).save(self.root / image)
