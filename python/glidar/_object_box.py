# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Bounding boxes of the objects of a frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import _core
from ._inputs import FloatArray
from ._poses import quaternion
from ._state import SameContent


@dataclass(frozen=True, eq=False)
class ObjectBox(SameContent):
    """The oriented bounding box of an object when the frame starts, and how much of the object the sensor sees
    (docs/boxes.md)."""

    name: str
    """Name of the object."""
    id: int
    """Number of the object in clouds."""
    class_name: str
    """Class of the object; "unlabelled" without one."""
    index: int
    """Index of the object in ``Scene.objects``."""
    frame_from_box: FloatArray
    """(4, 4): the box's centre, m, and its axes, which are those of the object, in the coordinate frame."""
    size_m: FloatArray
    """(3,): length along the box's x, y and z axes, m; tight around the mesh."""
    velocity_m_s: FloatArray
    """(3,): velocity of the centre relative to the world, m/s, in the axes of the coordinate frame."""
    points: int
    """Number of returns whose ground truth is the object."""
    beams: int
    """Number of beams that would hit the object if it were alone."""
    visible_beams: int
    """Number of these that hit it first in the scene."""
    occlusion: float
    """Fraction of ``beams`` that hit another object first: 1 - visible_beams / beams; NaN when beams is 0."""

    @property
    def centre_m(self) -> FloatArray:
        """(3,): the centre, m."""
        centre: FloatArray = self.frame_from_box[:3, 3]
        return centre

    @property
    def wxyz(self) -> FloatArray:
        """(4,): the orientation as a unit quaternion w x y z, w >= 0."""
        return quaternion(self.frame_from_box, "wxyz")

    @property
    def corners_m(self) -> FloatArray:
        """(8, 3): the corners, m; bit 0, 1 and 2 of the index select the end of x, y and z."""
        signs = np.array([[i >> axis & 1 for axis in range(3)] for i in range(8)]) - 0.5
        corners: FloatArray = (signs * self.size_m) @ self.frame_from_box[:3, :3].T + self.centre_m
        return corners


def boxes_of(core: _core.Frame, frame: str, all_objects: bool, classes: list[str]) -> list[ObjectBox]:
    """Converts the boxes of the extension."""
    frame_from_sensor = _core.cloud_from_sensor(core, frame)
    return [
        ObjectBox(
            name=_core.object_name(core, box),
            id=_core.object_id(core, box),
            class_name=_core.object_class(core, box),
            index=box.instance,
            frame_from_box=frame_from_sensor @ box.sensor_from_box,
            size_m=box.size_m,
            velocity_m_s=frame_from_sensor[:3, :3] @ box.velocity_m_s,
            points=box.points,
            beams=box.beams,
            visible_beams=box.visible_beams,
            occlusion=box.occlusion,
        )
        for box in _core.boxes(core, all_objects, classes)
    ]
