# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Geometric ground truth of frames."""

from __future__ import annotations

from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error
from ._inputs import FloatArray

CoreFrame: TypeAlias = _core.Frame


class MeasuredFrame(Protocol):
    """A frame that stores ground truth."""

    _core: CoreFrame


class GroundTruth:
    """The geometric ground truth of every beam, whether the sensor reports it or not.

    Arrays are (rows, cols) or (rows, cols, k), read-only views of the frame's memory. Where a beam hits nothing
    they are NaN, and indices are 2**32 - 1. Access to a value that the frame's columns do not need raises Error,
    because it is not kept.
    """

    __slots__ = ("_frame",)

    def __init__(self, frame: MeasuredFrame) -> None:
        self._frame = frame

    def _kept(self, name: str) -> npt.NDArray[Any]:
        found = self._frame._core.ground_truth(name)
        if found is None:
            raise Error(f"ground_truth.{name}", "not kept", "", "simulate(..., columns='all') keeps all ground truth")
        return found

    @property
    def range_m(self) -> FloatArray:
        """Distance along the beam from its origin, m."""
        return self._kept("range_m")

    @property
    def instance(self) -> npt.NDArray[np.uint32]:
        """Index of the object in ``scene.objects``."""
        return self._kept("instance")

    @property
    def primitive(self) -> npt.NDArray[np.uint32]:
        """Index of the triangle in the object's mesh."""
        return self._kept("primitive")

    @property
    def normal(self) -> npt.NDArray[np.float32]:
        """Unit normal of the triangle, facing the sensor, in the sensor's coordinate frame, (rows, cols, 3)."""
        return self._kept("normal")

    @property
    def shading_normal(self) -> npt.NDArray[np.float32]:
        """Interpolated unit normal with the normal map, in the sensor's coordinate frame, (rows, cols, 3)."""
        return self._kept("shading_normal")

    @property
    def cos_incidence(self) -> npt.NDArray[np.float32]:
        """Cosine between the reversed beam and `normal`."""
        return self._kept("cos_incidence")

    @property
    def cos_shading(self) -> npt.NDArray[np.float32]:
        """Cosine between the reversed beam and `shading_normal`."""
        return self._kept("cos_shading")

    @property
    def barycentrics(self) -> npt.NDArray[np.float32]:
        """Barycentric weights of the triangle's vertices 1 and 2, (rows, cols, 2)."""
        return self._kept("barycentrics")

    @property
    def colour(self) -> npt.NDArray[np.float32]:
        """Diffuse RGB colour, (rows, cols, 3)."""
        return self._kept("colour")

    @property
    def object_point_m(self) -> FloatArray:
        """The hit point in the object's coordinate frame before scale, m, (rows, cols, 3)."""
        return self._kept("object_point_m")

    @property
    def radial_velocity_m_s(self) -> FloatArray:
        """Rate at which the distance from the beam's origin to the hit point of the object grows, m/s."""
        return self._kept("radial_velocity_m_s")
