# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Objects of a scene."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import Error, shown
from ._inputs import FloatArray, floats, numbers, one_of, text_of, whole
from ._mesh import Mesh
from ._scene_data import SceneData
from ._sensor import plain


class SceneObject:
    """One instance of a model in a scene. Setting an attribute changes the scene, but no earlier measurement.
    Objects are equal when they have the same index in the same scene. A pickle or deep copy of an object
    includes its scene."""

    __slots__ = ("_index", "_scene")

    def __init__(self, scene: SceneData, index: int) -> None:
        self._scene = scene
        self._index = index

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, SceneObject):
            return NotImplemented
        return self._scene is other._scene and self._index == other._index

    def __hash__(self) -> int:
        return hash((id(self._scene), self._index))

    def _info(self) -> dict[str, Any]:
        return self._scene._core.object(self._index)

    def _is_taken(self, attribute: str, value: Any) -> bool:
        """Whether another object has the name or id."""
        recipe = self._scene._recipe
        return recipe.register(len(recipe.core)).is_taken(attribute, value, self._index)

    def _set(self, **changes: Any) -> None:
        self._scene._recipe.set_object(self._index, changes)

    @property
    def index(self) -> int:
        """Its index in ``scene.objects``, and in ``GroundTruth.instance``."""
        return self._index

    @property
    def name(self) -> str:
        """Its name, unique in the scene."""
        return str(self._info()["name"])

    @name.setter
    def name(self, name: str) -> None:
        if self._is_taken("name", text_of(name, "name")):
            raise Error("name", f"{name!r}, which another object has", "a name that is unique in the scene")
        self._set(name=name)

    @property
    def id(self) -> int:
        """Its id, unique in the scene; the value of the clouds' column `instance`."""
        return int(self._info()["id"])

    @id.setter
    def id(self, number: int) -> None:
        if self._is_taken("id", whole(number, "id", 2**32 - 2)):
            raise Error("id", f"{number}, which another object has", "an id that is unique in the scene")
        self._set(id=number)

    @property
    def class_name(self) -> str:
        """Name of its semantic class."""
        return str(self._info()["class_name"])

    @class_name.setter
    def class_name(self, name: str) -> None:
        self._set(class_name=text_of(name, "class_name"))

    @property
    def pose(self) -> FloatArray:
        """world_from_object, (4, 4), m, without scale."""
        pose: FloatArray = self._info()["pose"]
        return pose

    @pose.setter
    def pose(self, pose: npt.ArrayLike) -> None:
        self._set(pose=floats(pose, "pose", (4, 4))[None])

    @property
    def scale(self) -> float | tuple[float, float, float]:
        """p_world = pose (scale p_object): one factor, or (x, y, z) along the object's axes. Negative factors mirror.

        Different or negative factors need a scaled copy of the mesh in memory."""
        x, y, z = self._info()["scale"]
        return float(x) if x == y == z else (float(x), float(y), float(z))

    @scale.setter
    def scale(self, scale: npt.ArrayLike) -> None:
        given = numbers(scale, "scale", (3,))
        factors = floats(given, "scale", (3,)) if given.ndim else np.full(3, float(floats(given, "scale", ())))
        self._set(scale=tuple(factors.tolist()))

    @property
    def visible_to(self) -> tuple[str | int, ...]:
        """The only sensors that see it: names of sensors of ``scene.rig``, "sensor" without a rig, or sensor_ids; empty:
        all see it.

        A measurement has its sensor_id, by default 0, which is "sensor"."""
        return self._sensors("visible_to")

    @visible_to.setter
    def visible_to(self, sensors: Iterable[str | int]) -> None:
        self._set(visible_to=self._sensor_ids(sensors, "visible_to"))

    @property
    def hidden_from(self) -> tuple[str | int, ...]:
        """Sensors that do not see it, as in ``visible_to``; for example those on the robot that it is a part of."""
        return self._sensors("hidden_from")

    @hidden_from.setter
    def hidden_from(self, sensors: Iterable[str | int]) -> None:
        self._set(hidden_from=self._sensor_ids(sensors, "hidden_from"))

    def _rig_ids(self) -> dict[str, int]:
        """The sensor_ids of the rig by name; of the only sensor without one."""
        return {name: number for number, (name, *_) in enumerate(self._scene._core.rig()) if name} or {"sensor": 0}

    def _sensors(self, key: str) -> tuple[str | int, ...]:
        names = {number: name for name, number in self._rig_ids().items()}
        return tuple(names.get(number, number) for number in self._info()[key])

    def _sensor_ids(self, sensors: Iterable[str | int], where: str) -> list[int]:
        if isinstance(sensors, (str, bytes)) or not isinstance(sensors, Iterable):
            raise Error(where, shown(sensors), "a list of names or sensor_ids")
        ids = self._rig_ids()
        return [
            ids[one_of(sensor, where, tuple(ids))] if isinstance(sensor, str) else whole(sensor, where, 2**32 - 1)
            for sensor in sensors
        ]

    @property
    def materials(self) -> list[str]:
        """Names of its materials."""
        return self._scene._core.materials(self._index)

    def set_materials(self, changes: Mapping[str, Any]) -> None:
        """Changes its materials, but not those of its instances.

        Args:
            changes: as ``materials`` in scene files (docs/files.md): keys are names of materials, or "*" for
                all, e.g. ``{"*": {"surface": "asphalt"}}`` or ``{"*": {"diffuse": [0.9, 0.1, 0.1]}}``.

        Raises:
            Error: names the field, what is allowed and the nearest known key.
        """
        self._scene._recipe.set_materials(self._index, json.dumps(plain(changes, "materials"), ensure_ascii=False))

    @property
    def source(self) -> str:
        """The file or built-in model of its mesh."""
        return str(self._info()["source"])

    @property
    def mesh(self) -> Mesh:
        """Its mesh: copies of the arrays, in the object's coordinate frame before scale."""
        arrays: dict[str, Any] = self._scene._core.mesh(self._index)
        return Mesh(**arrays)

    @property
    def triangles(self) -> int:
        """Number of triangles of its mesh."""
        return int(self._info()["triangles"])

    def __repr__(self) -> str:
        return f"<glidar.SceneObject {self.index} {self.name!r} of {self.source}: {self.triangles} triangles>"
