# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Trajectories: poses as functions of time."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, TypeAlias, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error
from ._inputs import FloatArray, floats, numbers, one_of, path_of, shape_text
from ._inputs import times_ns as whole_times_ns
from ._state import Immutable, key_of, part, restoring, make_state

_MAX_TIME_S = 9.2e9


def _ns(value_s: float, where: str) -> int:
    seconds = float(floats(value_s, where, ()))
    if abs(seconds) > _MAX_TIME_S:
        raise Error(where, f"{seconds}", "seconds up to 9.2e9")
    return round(seconds * 1e9)


def _times_ns(value_s: npt.ArrayLike, where: str) -> npt.NDArray[np.int64]:
    seconds = floats(value_s, where, (None,))
    if np.abs(seconds).max() > _MAX_TIME_S:
        raise Error(where, f"{seconds[np.abs(seconds).argmax()]}", "seconds up to 9.2e9")
    return np.rint(seconds * 1e9).astype(np.int64)


def _is_spline(interpolation: str) -> bool:
    return one_of(interpolation, "interpolation", ("linear", "spline")) == "spline"


class Trajectory(Immutable):
    """A pose as a pure function of time: of a sensor (world_from_sensor) or an object (world_from_object).

    Poses are (4, 4), m. Times are seconds from -9.2e9 to 9.2e9, rounded to nanoseconds; those since 1970 are exact as
    whole nanoseconds only, because a float has steps of 238 ns there. Trajectories are immutable. Two are equal when
    they have the same type and bit-identical numbers; they can be hashed, copied and pickled. Every constructor raises
    Error for a wrong shape or a number that is not finite.
    """

    __slots__ = ("_core",)

    def __init__(self, core: _core.Trajectories) -> None:
        self._core = core

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Trajectory):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> object:
        return key_of(_core.trajectory_states(self._core))

    def __getstate__(self) -> dict[str, Any]:
        return make_state("Trajectory", motion=_core.trajectory_states(self._core))

    def __setstate__(self, state: dict[str, Any]) -> None:
        with restoring("Trajectory", state):
            motion = _core.restore_trajectories(part(state, "motion", list))
            if len(motion) != 1:
                raise ValueError(f"{len(motion)} trajectories instead of one")
            self._core = motion

    @staticmethod
    def constant(pose: npt.ArrayLike) -> Trajectory:
        """A constant pose, (4, 4)."""
        return Trajectory(_core.constant(floats(pose, "pose", (4, 4))[None], "pose"))

    @staticmethod
    def spin(pose: npt.ArrayLike, rate_rad_s: npt.ArrayLike, *, t0_s: float = 0.0) -> Trajectory:
        """Rotation about the body's origin from `pose` at t0, at a constant rate (3,), rad/s, about the body's axes."""
        start = floats(pose, "pose", (4, 4))[None]
        return Trajectory(_core.spin(start, floats(rate_rad_s, "rate_rad_s", (3,)), _ns(t0_s, "t0_s")))

    @staticmethod
    def twist(
        pose: npt.ArrayLike,
        angular_rad_s: npt.ArrayLike = (0.0, 0.0, 0.0),
        linear_m_s: npt.ArrayLike = (0.0, 0.0, 0.0),
        *,
        in_world: bool = False,
        t0_s: float = 0.0,
    ) -> Trajectory:
        """Constant screw motion from `pose` at t0. Angular (3,), rad/s, and linear velocity (3,), m/s, are along
        the body's axes, or with ``in_world`` along those of the world."""
        start = floats(pose, "pose", (4, 4))[None]
        angular = floats(angular_rad_s, "angular_rad_s", (3,))
        linear = floats(linear_m_s, "linear_m_s", (3,))
        return Trajectory(_core.twist(start, angular, linear, in_world, _ns(t0_s, "t0_s")))

    @staticmethod
    def timed(
        times_s: npt.ArrayLike | None,
        poses: npt.ArrayLike,
        *,
        times_ns: npt.ArrayLike | None = None,
        interpolation: str = "linear",
    ) -> Trajectory:
        """Poses (N, 4, 4) at increasing times (N,), s. The first and last pose are held outside the interval.

        Args:
            times_ns: the times in whole nanoseconds, if times_s is None.
            interpolation: "linear": positions linearly, rotations by slerp; "spline": twice continuously
                differentiable, as IMUs need.
        """
        if (times_s is None) == (times_ns is None):
            raise Error("times_s and times_ns", "both" if times_ns is not None else "neither", "one of them")
        times = _times_ns(times_s, "times_s") if times_s is not None else whole_times_ns(times_ns, "times_ns")
        return Trajectory(_core.timed(times, floats(poses, "poses", (len(times), 4, 4)), _is_spline(interpolation)))

    @staticmethod
    def tumbling(
        pose: npt.ArrayLike,
        moments_kg_m2: npt.ArrayLike,
        rate_rad_s: npt.ArrayLike,
        *,
        body_from_principal: npt.ArrayLike | None = None,
        velocity_m_s: npt.ArrayLike = (0.0, 0.0, 0.0),
        t0_s: float = 0.0,
    ) -> Trajectory:
        """Torque-free motion of a rigid body, in closed form.

        Args:
            pose: world_from_body at t0, (4, 4).
            moments_kg_m2: principal moments of inertia (3,); only their ratios matter.
            rate_rad_s: angular velocity about the principal axes (3,) at t0.
            body_from_principal: centre of mass and principal axes in the body frame, (4, 4); None: the body frame.
            velocity_m_s: velocity of the centre of mass in the world (3,).
        """
        principal = np.eye(4) if body_from_principal is None else body_from_principal
        poses = np.stack(
            [floats(pose, "pose", (4, 4)), floats(principal, "body_from_principal", (4, 4))]
        )
        moments = floats(moments_kg_m2, "moments_kg_m2", (3,))
        rate = floats(rate_rad_s, "rate_rad_s", (3,))
        velocity = floats(velocity_m_s, "velocity_m_s", (3,))
        return Trajectory(_core.tumbling(poses, moments, rate, velocity, _ns(t0_s, "t0_s")))

    @staticmethod
    def load(
        path: str | os.PathLike[str],
        *,
        rate_hz: float | None = None,
        times_file: str | os.PathLike[str] | None = None,
        start_s: float | None = None,
        interpolation: str = "linear",
    ) -> Trajectory:
        """Timed poses from a TUM, KITTI, EuRoC or CSV file. The first row determines the format.

        Args:
            rate_hz: poses per second of a KITTI file, the first at 0. Or:
            times_file: file with the times of a KITTI file, one per line, s.
            start_s: shifts all times so that the first is this, s.
            interpolation: "linear" or "spline", see ``timed``.

        Raises:
            Error: the file cannot be read or is malformed, with its line and column.
        """
        start = None if start_s is None else _ns(start_s, "start_s")
        rate = None if rate_hz is None else float(floats(rate_hz, "rate_hz", ()))
        times = "" if times_file is None else path_of(times_file, "times_file")
        spline = _is_spline(interpolation)
        return Trajectory(_core.load_trajectory(path_of(path, "path"), rate, times, start, spline))

    def pose_at(self, time_s: float) -> FloatArray:
        """The pose at a time (s), (4, 4)."""
        result: FloatArray = self._core.poses_at(np.array([_ns(time_s, "time_s")]))[0]
        return result

    def poses_at(self, times_s: npt.ArrayLike) -> FloatArray:
        """The poses (N, 4, 4) at times (N,), s."""
        return self._core.poses_at(_times_ns(times_s, "times_s"))

    def poses_at_ns(self, times_ns: npt.ArrayLike) -> FloatArray:
        """The poses (N, 4, 4) at times (N,), whole nanoseconds, such as ``Frame.stamp_ns``."""
        return self._core.poses_at(whole_times_ns(times_ns, "times_ns"))

    @property
    def known_s(self) -> tuple[float, float]:
        """First and last time, s, for which the pose is known; about -9.2e9 and 9.2e9 when it is known always."""
        first, last = self._core.valid_interval()
        return first / 1e9, last / 1e9

    @property
    def known_ns(self) -> tuple[int, int]:
        """The same in nanoseconds; the least and greatest int64 when it is known always."""
        return self._core.valid_interval()


def first_time_ns(core: _core.Trajectories) -> int:
    """The first time of timed poses, else 0."""
    first, _ = core.valid_interval()
    return 0 if first == np.iinfo(np.int64).min else first


#: A pose, (4, 4), or a trajectory.
PoseLike: TypeAlias = Union[npt.ArrayLike, Trajectory]


def _has_trajectory(value: object) -> bool:
    """Whether it is a Trajectory or a list that contains one, which NumPy cannot convert."""
    if isinstance(value, (list, tuple)):
        return any(isinstance(part, Trajectory) for part in value)
    return isinstance(value, Trajectory)


def trajectories(value: PoseLike | Sequence[PoseLike], where: str) -> _core.Trajectories:
    """One or several trajectories from an array (N, 4, 4), or a list of poses and trajectories."""
    if isinstance(value, Trajectory):
        return value._core
    if _has_trajectory(value):
        parts: Sequence[PoseLike] = value  # type: ignore[assignment]
        return _core.joined([trajectories(part, f"{where}[{k}]") for k, part in enumerate(parts)])
    if type(value) is np.ndarray and value.shape == (4, 4) and value.dtype == np.float64:
        return _core.constant(np.ascontiguousarray(value)[None], where)  # checks the numbers too
    given = numbers(value, where, (None, 4, 4))
    if given.ndim == 2:
        return _core.constant(floats(given, where, (4, 4))[None], where)
    return _core.constant(floats(given, where, (None, 4, 4)), where)


def is_per_frame(value: object, where: str) -> bool:
    """Whether the array has poses of objects for each frame: N x k x 4 x 4."""
    return not _has_trajectory(value) and numbers(value, where, (None, None, 4, 4)).ndim == 4


def object_trajectories(
    value: PoseLike | Sequence[PoseLike] | None, count: int, objects: int, where: str = "objects"
) -> _core.Trajectories | None:
    """Trajectories of `objects` objects for `count` frames: for each frame, or the same for all."""
    if value is None:
        return None
    if is_per_frame(value, where):
        poses = floats(value, where, (None, None, 4, 4))
        if poses.shape[:2] != (count, objects):
            found = f"an array {shape_text(poses.shape)}"
            raise Error(where, found, f"{count} x {objects} x 4 x 4: frames, then objects")
        return _core.constant(poses.reshape(-1, 4, 4), where)
    result = trajectories(value, where)
    if len(result) != objects:
        raise Error(where, f"{len(result)} poses", f"{objects}, one per object of the scene")
    return result


