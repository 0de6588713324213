# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The truth beside a frame."""

from __future__ import annotations

from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error
from ._inputs import FloatArray

CoreFrame: TypeAlias = _core.Frame


class MeasuredFrame(Protocol):
    """A frame whose memory holds the ground truth."""

    _core: CoreFrame


class GroundTruth:
    """What is there, whether the sensor reports it or not. Arrays are (rows, cols) or
    (rows, cols, k), read-only views of the frame's memory. NaN, and 2**32 - 1 for indices, where the
    beam hits nothing. What the frame's columns do not need is not kept: asking for it is an Error."""

    __slots__ = ("_frame",)

    def __init__(self, frame: MeasuredFrame) -> None:
        self._frame = frame

    def _kept(self, name: str) -> npt.NDArray[Any]:
        found = self._frame._core.ground_truth(name)
        if found is None:
            raise Error(f"truth.{name}", "not kept", "", "simulate(..., columns='all') keeps all truth")
        return found

    @property
    def range_m(self) -> FloatArray:
        """Distance along the beam from its origin, m."""
        return self._kept("range_m")

    @property
    def instance(self) -> npt.NDArray[np.uint32]:
        """Which object of the scene: ``scene.objects[instance]``."""
        return self._kept("instance")

    @property
    def primitive(self) -> npt.NDArray[np.uint32]:
        """Which triangle of the object's mesh."""
        return self._kept("primitive")

    @property
    def normal(self) -> npt.NDArray[np.float32]:
        """Unit normal of the triangle towards the sensor, in the sensor's frame, (rows, cols, 3)."""
        return self._kept("normal")

    @property
    def shading_normal(self) -> npt.NDArray[np.float32]:
        """Interpolated normal, bent by the normal map; likewise."""
        return self._kept("shading_normal")

    @property
    def cos_incidence(self) -> npt.NDArray[np.float32]:
        """Cosine between the beam, turned round, and `normal`."""
        return self._kept("cos_incidence")

    @property
    def cos_shading(self) -> npt.NDArray[np.float32]:
        """The same with `shading_normal`."""
        return self._kept("cos_shading")

    @property
    def barycentrics(self) -> npt.NDArray[np.float32]:
        """Weights of the triangle's corners 1 and 2, (rows, cols, 2)."""
        return self._kept("barycentrics")

    @property
    def colour(self) -> npt.NDArray[np.float32]:
        """Diffuse rgb, (rows, cols, 3)."""
        return self._kept("colour")

    @property
    def object_point_m(self) -> FloatArray:
        """The point hit, in the object's own frame before scale, m, (rows, cols, 3)."""
        return self._kept("object_point_m")
