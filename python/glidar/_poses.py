# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Poses: rigid transforms as 4x4 arrays, ``target_from_source``, metres, right-handed."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error, shown
from ._inputs import FloatArray, floats, numbers


def pose(
    xyz: npt.ArrayLike = (0.0, 0.0, 0.0),
    *,
    wxyz: npt.ArrayLike | None = None,
    xyzw: npt.ArrayLike | None = None,
    matrix: npt.ArrayLike | None = None,
) -> FloatArray:
    """A pose as a (4, 4) array from a position and a rotation.

    Args:
        xyz: position of the source's origin in the target frame, (3,), m.
        wxyz: quaternion (4,) with w first (Blender, MuJoCo); normalised. Or:
        xyzw: quaternion (4,) with w last (ROS, TUM, SciPy); normalised. Or:
        matrix: rotation matrix (3, 3). None of the three: no rotation.

    Raises:
        Error: several rotations, a wrong shape, a number that is not finite, or a quaternion of zeros.
    """
    given = [name for name, value in (("wxyz", wxyz), ("xyzw", xyzw), ("matrix", matrix)) if value is not None]
    if len(given) > 1:
        raise Error("pose", f"{' and '.join(given)} are given", "one rotation")
    position = floats(xyz, "xyz", (3,))
    if matrix is not None:
        return _rigid(floats(matrix, "matrix", (3, 3)), position, "pose")
    quaternion = np.array([1.0, 0.0, 0.0, 0.0])
    if wxyz is not None:
        quaternion = floats(wxyz, "wxyz", (4,))
    elif xyzw is not None:
        quaternion = np.roll(floats(xyzw, "xyzw", (4,)), 1)
    return _core.make_pose(position, quaternion)


def _rigid(rotation: FloatArray, position: FloatArray, name: str) -> FloatArray:
    """The pose with a rotation matrix, after checking that it is a rotation."""
    result = np.eye(4)
    result[:3, :3] = rotation
    result[:3, 3] = position
    checked: FloatArray = _core.constant(result[None], name).poses_at(np.zeros(1, np.int64))[0]
    return checked


def inverse(pose: FloatArray) -> FloatArray:
    """The inverse of a rigid transform (4, 4), with the same bits on every machine, unlike ``numpy.linalg.inv``."""
    result = np.eye(4)
    result[:3, :3] = pose[:3, :3].T
    result[:3, 3] = -(pose[:3, :3] * pose[:3, 3, None]).sum(axis=0)
    return result


def look_at(
    eye: npt.ArrayLike, target: npt.ArrayLike, up: npt.ArrayLike | None = None, *, boresight: str = "z"
) -> FloatArray:
    """The pose (world_from_sensor, (4, 4), m) of a sensor at `eye` that looks at `target`.

    Args:
        eye, target: positions in the world, (3,), m.
        up: world direction that is up in the image, (3,); None: +z, or +x when the line of sight
            is vertical (the sine of its angle to z is at most 1e-6).
        boresight: the axis that points at the target: "z" for cameras (x right, y down, z forward), "x" for
            LiDARs (x forward, y left, z up); see ``Sensor.boresight``.

    Raises:
        Error: eye and target coincide, or `up` is parallel to the line of sight.
    """
    if boresight not in ("x", "z"):
        raise Error("boresight", shown(boresight), "'x' or 'z'")
    upwards = None if up is None else floats(up, "up", (3,))
    optical = _core.look_at(floats(eye, "eye", (3,)), floats(target, "target", (3,)), upwards)
    if boresight == "z":
        return optical
    optical_from_body = np.array([[0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
    body: FloatArray = optical @ optical_from_body
    return body


def quaternion(matrix: npt.ArrayLike, order: str) -> FloatArray:
    """The unit quaternion (4,), w >= 0, of a pose (4, 4) or a rotation (3, 3), in the `order` "wxyz" or "xyzw".

    Raises:
        Error: a wrong shape or order, or a matrix that is not a rotation.
    """
    if order not in ("wxyz", "xyzw"):
        raise Error("order", shown(order), "'wxyz' or 'xyzw'")
    given = numbers(matrix, "matrix", (4, 4))
    size = 4 if given.shape == (4, 4) else 3
    rotation = floats(given, "matrix", (size, size))[:3, :3]
    wxyz = _core.quaternion(np.ascontiguousarray(_rigid(rotation, np.zeros(3), "matrix")[:3, :3]))
    return wxyz if order == "wxyz" else np.roll(wxyz, -1)
