# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Inertial measurement units: presets, files and IMUs defined in code, and their samples."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error
from ._inputs import MAX_UINT32, MAX_UINT64, FloatArray, floats, path_of, times_ns, whole
from ._scene import Scene
from ._sensor import plain
from ._state import Immutable, part, restoring, make_state
from ._trajectory import PoseLike, Trajectory, first_time_ns, trajectories

_MAX_TIME_S = 9.2e9
#: Acceleration of free fall in a world whose z axis points up, m/s^2.
STANDARD_GRAVITY = (0.0, 0.0, -9.80665)


class Imu(Immutable):
    """An inertial measurement unit: rate and errors of its gyroscopes and accelerometers (docs/imu.md).

    IMUs come from ``load_imu`` and ``Imu.from_dict``. Two are equal when all their numbers and names are
    bit-identical. They can be hashed, copied and pickled; a pickled IMU needs no file.
    """

    __slots__ = ("_core",)

    def __init__(self, core: _core.Imu) -> None:
        self._core = core

    @staticmethod
    def from_dict(description: Mapping[str, Any]) -> Imu:
        """An IMU from the keys of an IMU file. Raises Error with the field."""
        return Imu(_core.parse_imu(json.dumps(plain(description, "imu"))))

    def to_dict(self) -> dict[str, Any]:
        """All values with the keys of an IMU file: ``Imu.from_dict(imu.to_dict()) == imu``."""
        document: dict[str, Any] = json.loads(self._core.document())
        return document

    def without_errors(self) -> Imu:
        """An IMU of the same rate that measures the ground truth."""
        return Imu(self._core.ground_truth())

    @property
    def name(self) -> str:
        """The name in its file."""
        return self._core.name

    @property
    def rate_hz(self) -> float:
        """Samples per second."""
        return self._core.rate_hz

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Imu):
            return NotImplemented
        return self._core.document() == other._core.document()

    def __hash__(self) -> int:
        return hash(self._core.document())

    def __getstate__(self) -> dict[str, Any]:
        return make_state("Imu", document=self._core.document())

    def __setstate__(self, state: dict[str, Any]) -> None:
        with restoring("Imu", state):
            self._core = _core.parse_imu(part(state, "document", str))

    def __repr__(self) -> str:
        return f"<glidar.Imu {self.name!r}, {self.rate_hz:g} Hz>"


@dataclass(frozen=True, eq=False)
class RigImu:
    """An IMU on the rig of a scene file."""

    name: str
    number: int
    """Its position in the scene file, from 0, which selects its random numbers."""
    imu: Imu
    rig_from_imu: FloatArray
    """(4, 4), m: the pose of the IMU in the rig's coordinate frame."""


@dataclass(frozen=True, eq=False)
class ImuSamples:
    """N samples of an IMU with their ground truth. Vectors (N, 3) are in the axes of the IMU, except velocity."""

    t_ns: npt.NDArray[np.int64]
    """Times, ns, (N,)."""
    angular_velocity: FloatArray
    """Measured, rad/s."""
    specific_force: FloatArray
    """Measured, m/s^2; at rest +9.81 upwards."""
    true_angular_velocity: FloatArray
    """rad/s."""
    true_specific_force: FloatArray
    """m/s^2."""
    gyroscope_bias: FloatArray
    """rad/s: turn-on bias, correlated bias and random walk together."""
    accelerometer_bias: FloatArray
    """m/s^2: the same for the accelerometers."""
    velocity: FloatArray
    """m/s, axes of the world."""
    world_from_imu: FloatArray
    """Poses, (N, 4, 4), m."""

    def __len__(self) -> int:
        return len(self.t_ns)


def imu_names() -> list[str]:
    """Names of the IMU presets."""
    return _core.imu_names()


def load_imu(name_or_path: str | os.PathLike[str]) -> Imu:
    """An IMU by the name of a preset (``imu_names()``), or from an IMU file (YAML). Raises Error."""
    return Imu(_core.load_imu(path_of(name_or_path, "imu")))


def rig_imus(scene: Scene) -> dict[str, RigImu]:
    """The IMUs of a scene file by name."""
    return {
        name: RigImu(name, number, Imu(core), pose)
        for number, (name, core, pose) in enumerate(scene._core.imus())
    }


def _ns(value_s: float, where: str) -> int:
    seconds = float(floats(value_s, where, ()))
    if abs(seconds) > _MAX_TIME_S:
        raise Error(where, f"{seconds}", "seconds up to 9.2e9")
    return round(seconds * 1e9)


def _chosen_ns(name: str, time_s: float | None, time_ns: int | None, default_ns: int) -> int:
    if time_s is not None and time_ns is not None:
        raise Error(f"{name}_s and {name}_ns", "both are given", "one of them")
    if time_s is not None:
        return _ns(time_s, f"{name}_s")
    return default_ns if time_ns is None else int(times_ns([time_ns], f"{name}_ns")[0])


def simulate_imu(
    imu: Imu | str | os.PathLike[str],
    trajectory: PoseLike,
    duration_s: float,
    *,
    start_s: float | None = None,
    turned_on_s: float | None = None,
    start_ns: int | None = None,
    turned_on_ns: int | None = None,
    seed: int = 1,
    number: int = 0,
    gravity_m_s2: npt.ArrayLike = STANDARD_GRAVITY,
) -> ImuSamples:
    """The samples of an IMU from a time, included, to the end of a duration, excluded.

    Samples are functions of their number: the same whether computed at once or in parts with the same
    ``turned_on_s``.

    Args:
        imu: an IMU, the name of a preset or the path of a file.
        trajectory: world_from_imu: a Trajectory, or a pose (4, 4).
        start_s: time of the first sample, s; None: the first time of timed poses, else 0.
        turned_on_s: time of sample 0, when random walks are 0; None: that of the first sample.
        start_ns, turned_on_ns: the same in whole nanoseconds, which are exact for times since 1970.
        seed: seed of random numbers; number: of the IMU on the rig, which selects its random numbers.
        gravity_m_s2: acceleration of free fall in the world, (3,); zeros in space.

    Raises:
        Error: an argument is invalid, or there are more than 10 million samples.
    """
    run = _core.ImuRun()
    motion = trajectories(trajectory, "trajectory")
    run.from_ns = _chosen_ns("start", start_s, start_ns, first_time_ns(motion))
    run.until_ns = run.from_ns + _ns(duration_s, "duration_s")
    run.start_ns = _chosen_ns("turned_on", turned_on_s, turned_on_ns, run.from_ns)
    run.seed = whole(seed, "seed", MAX_UINT64)
    run.imu = whole(number, "number", MAX_UINT32)
    run.gravity_m_s2 = floats(gravity_m_s2, "gravity_m_s2", (3,))
    chosen = imu if isinstance(imu, Imu) else load_imu(imu)
    arrays = _core.simulate_imu(chosen._core, motion, run)
    arrays["t_ns"] = arrays["t_ns"].reshape(-1)
    arrays["world_from_imu"] = arrays["world_from_imu"].reshape(-1, 4, 4)
    return ImuSamples(**arrays)


def simulate_imus(
    scene: Scene,
    duration_s: float,
    *,
    pose: PoseLike | None = None,
    start_s: float | None = None,
    start_ns: int | None = None,
    seed: int = 1,
) -> dict[str, ImuSamples]:
    """The samples of every IMU of a scene file by name; all are turned on at the first time of timed poses of the
    rig, else at 0.

    Args:
        pose: the rig's pose, (4, 4), or Trajectory; None: that of the scene file.

    The other arguments and the errors are those of ``simulate_imu``; gravity is that of the scene file.
    """
    imus = rig_imus(scene)
    if not imus:
        raise Error("scene", "the scene has no IMUs", "a scene file with imus")
    rig = scene._core.rig_motion() if pose is None else trajectories(pose, "pose")
    if rig is None:
        raise Error("scene", "the scene file gives no pose of the rig", "a pose", "pass pose=")
    return {
        name: simulate_imu(
            one.imu,
            Trajectory(_core.mounted(rig, np.ascontiguousarray(one.rig_from_imu)[None])),
            duration_s,
            start_s=start_s,
            start_ns=start_ns,
            turned_on_ns=first_time_ns(rig),
            seed=seed,
            number=one.number,
            gravity_m_s2=scene._core.gravity_m_s2,
        )
        for name, one in imus.items()
    }
