# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The contents of a scene, which its objects, simulators and frames share."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias

from . import _core
from ._errors import Error
from ._inputs import FloatArray, text_list
from ._recipe import Recipe
from ._sensor import Sensor
from ._state import has_same_fields

CoreScene: TypeAlias = _core.Scene


@dataclass(frozen=True, eq=False)
class RigSensor:
    """A sensor on the rig of a scene file. Rig sensors are equal when all their parts are equal."""

    name: str
    number: int
    """Its position in the scene file, from 0: the sensor_id of its frames, which selects its random numbers."""
    sensor: Sensor
    rig_from_sensor: FloatArray
    """(4, 4), m: the sensor's pose in the rig's coordinate frame."""

    def __eq__(self, other: object) -> bool:
        return has_same_fields(self, other)

    __hash__ = None  # type: ignore[assignment]  # the array can be changed


class SceneData:
    """The contents of a scene: objects, sensors and the recipe that creates them. ``Scene`` adds how to edit it."""

    _recipe: Recipe

    @property
    def _core(self) -> CoreScene:
        return self._recipe.core

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray] | None:
        """Minimum and maximum corner of the box around all objects, (3,) each, world frame, m; None when empty."""
        return self._core.bounds()

    @property
    def class_names(self) -> list[str]:
        """Names of classes. The column `class` of clouds contains indices into this list."""
        return self._core.class_names

    @property
    def box_classes(self) -> list[str]:
        """Names of the classes whose objects have boxes in outputs, or ["all"]; empty: the countable ones, so not
        those of roads, buildings and terrain (docs/boxes.md). Can be set; "all" is allowed."""
        return self._core.box_classes

    @box_classes.setter
    def box_classes(self, names: str | Iterable[str]) -> None:
        self._recipe.set_box_classes(text_list(names, "box_classes"))

    @property
    def sensor(self) -> Sensor | None:
        """The sensor of the scene file; None when it has none, or a rig of several."""
        rig = self._core.rig()
        return Sensor(rig[0][1]) if len(rig) == 1 else None

    @property
    def rig(self) -> dict[str, RigSensor]:
        """The sensors of the scene file by name; a single one has the name ""."""
        return {
            name: RigSensor(name, number, Sensor(core), pose)
            for number, (name, core, pose) in enumerate(self._core.rig())
        }


def not_a_scene(value: object) -> Error:
    """The error for a value of another type where a scene is required."""
    return Error("scene", f"a {type(value).__name__}", "a Scene", "glidar.load_scene() returns one")
