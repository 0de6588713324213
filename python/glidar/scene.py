# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Scenes: models and meshes, placed."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error
from ._inputs import FloatArray, floats, log, one_of, whole
from .sensor import Sensor, load_sensor
from .simulator import Simulator

_UNITS = {"mm": 0.001, "cm": 0.01, "m": 1.0, "in": 0.0254}
_AXES = ("x", "y", "z")
_MOST_SIMULATORS = 8


class Object:
    """One placed model of a scene. Setting an attribute changes the scene: what was measured before
    stays as it was."""

    __slots__ = ("_index", "_scene")

    def __init__(self, scene: Scene, index: int) -> None:
        self._scene = scene
        self._index = index

    def _info(self) -> dict[str, Any]:
        return self._scene._core.object(self._index)

    def _set(self, **changes: Any) -> None:
        given: dict[str, Any] = {"pose": None, "scale": None, "name": None, "id": None, "class_name": None}
        self._scene._simulators.clear()
        self._scene._core.set_object(self._index, **(given | changes))

    @property
    def index(self) -> int:
        """Its place in the scene, as ``Truth.instance`` has it."""
        return self._index

    @property
    def name(self) -> str:
        """Its name."""
        return str(self._info()["name"])

    @name.setter
    def name(self, name: str) -> None:
        self._set(name=name)

    @property
    def id(self) -> int:
        """The user's number for it, which clouds tell in the column `instance`."""
        return int(self._info()["id"])

    @id.setter
    def id(self, number: int) -> None:
        self._set(id=whole(number, "id", 2**32 - 2))

    @property
    def class_name(self) -> str:
        """Its class."""
        return str(self._info()["class_name"])

    @class_name.setter
    def class_name(self, name: str) -> None:
        self._set(class_name=name)

    @property
    def pose(self) -> FloatArray:
        """world_from_object, 4x4, without scale."""
        pose: FloatArray = self._info()["pose"]
        return pose

    @pose.setter
    def pose(self, pose: npt.ArrayLike) -> None:
        self._set(pose=floats(pose, "pose", (4, 4))[None])

    @property
    def scale(self) -> float:
        """p_world = pose (scale p_object)."""
        return float(self._info()["scale"])

    @scale.setter
    def scale(self, scale: float) -> None:
        self._set(scale=float(floats(scale, "scale", ())))

    @property
    def source(self) -> str:
        """Where its mesh came from."""
        return str(self._info()["source"])

    @property
    def triangles(self) -> int:
        """Triangles of its mesh."""
        return int(self._info()["triangles"])

    @property
    def vertices(self) -> FloatArray:
        """Vertices of its mesh in the object's own frame, before scale, m, (V, 3)."""
        return self._scene._core.vertices_m(self._index)

    @property
    def faces(self) -> npt.NDArray[np.uint32]:
        """Triangles of its mesh as indices of vertices, (T, 3)."""
        return self._scene._core.faces(self._index)

    def __repr__(self) -> str:
        return f"<glidar.Object {self.index} {self.name!r} of {self.source}: {self.triangles} triangles>"


class Scene:
    """All there is to see: models, each placed as an object.

    Args:
        source: a scene file (.yaml, .yml), a model file, or "builtin:asteroid", "builtin:sphere",
            "builtin:box", "builtin:torus", "builtin:plane"; None: an empty scene.
        unit: of a model file's numbers: "m", "cm", "mm", "in", or metres per unit.
        up: the axis of a model file that becomes z: "x", "y", "z"; None: axes as in the file.

    Raises:
        Error: the file cannot be read, with line, column and field where it has them.
    """

    def __init__(
        self,
        source: str | os.PathLike[str] | None = None,
        *,
        unit: str | float = "m",
        up: str | None = None,
    ) -> None:
        self._simulators: dict[tuple[int, str, int], Simulator] = {}
        self._core = _core.Scene()
        if source is None:
            return
        path = os.fspath(source)
        if path.endswith((".yaml", ".yml")):
            self._core = _core.load_scene(path, _metres(unit), _axis(up), True, log)
        else:
            self.add_model(path, unit=unit, up=up)

    def add_model(
        self,
        source: str | os.PathLike[str],
        *,
        unit: str | float = "m",
        up: str | None = None,
        **placing: Any,
    ) -> Object:
        """Adds a model file or "builtin:NAME".

        Args:
            unit, up: as for ``Scene``.
            placing: pose (4x4), scale, name, id, class_name of the object.
        """
        self._simulators.clear()
        index = self._core.add_model(os.fspath(source), _metres(unit), _axis(up), True, log)
        return self._placed(index, placing)

    def add_mesh(
        self,
        vertices: Any,
        triangles: npt.ArrayLike | None = None,
        *,
        normals: npt.ArrayLike | None = None,
        uvs: npt.ArrayLike | None = None,
        colours: npt.ArrayLike | None = None,
        **placing: Any,
    ) -> Object:
        """Adds a mesh from arrays, or from an object that has vertices and faces, as trimesh's.

        Args:
            vertices: (V, 3), m, in the object's own frame; or the mesh object, without the rest.
            triangles: (T, 3), indices of vertices, counter-clockwise seen from the front.
            normals: (V, 3), unit vectors; None: flat shading.
            uvs: (V, 2), v upwards.
            colours: (V, 3), 0..1.
            placing: pose (4x4), scale, name, id, class_name of the object.

        Raises:
            Error: a wrong shape, a number that is not finite, an index of no vertex.
        """
        if triangles is None and hasattr(vertices, "vertices") and hasattr(vertices, "faces"):
            vertices, triangles = vertices.vertices, vertices.faces
        if triangles is None:
            raise Error("triangles", "None", "indices of vertices, n x 3")
        corners = floats(vertices, "vertices", (None, 3))
        count = len(corners)
        name = str(placing.get("name", "mesh"))
        index = self._core.add_mesh(
            name,
            corners,
            _triangles(triangles, count),
            _per_vertex(normals, "normals", count, 3),
            _per_vertex(uvs, "uvs", count, 2),
            _per_vertex(colours, "colours", count, 3),
        )
        self._simulators.clear()
        return self._placed(index, placing)

    def add_copy(self, of: Object, **placing: Any) -> Object:
        """Adds another object with the mesh and materials of one that is there; costs no memory.

        Args:
            placing: pose (4x4), scale, name, id, class_name; as those of the first when not given.
        """
        self._simulators.clear()
        return self._placed(self._core.add_instance(of.index), placing)

    def _placed(self, index: int, placing: dict[str, Any]) -> Object:
        made = Object(self, index)
        for name, value in placing.items():
            one_of(name, "argument", ("pose", "scale", "name", "id", "class_name"))
            setattr(made, name, value)
        return made

    @property
    def objects(self) -> tuple[Object, ...]:
        """All objects, in order."""
        return tuple(Object(self, index) for index in range(len(self._core)))

    def __getitem__(self, name: str) -> Object:
        for candidate in self.objects:
            if candidate.name == name:
                return candidate
        raise Error("object", repr(name), ", ".join(o.name for o in self.objects) or "the scene is empty")

    def __len__(self) -> int:
        return len(self._core)

    def __iter__(self) -> Iterator[Object]:
        return iter(self.objects)

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray] | None:
        """Least and greatest corner of the box around all objects, world, m; None when empty."""
        return self._core.bounds()

    @property
    def class_names(self) -> list[str]:
        """Names of classes; their places are what clouds tell in the column `class`."""
        return self._core.class_names

    @property
    def sensor(self) -> Sensor | None:
        """The sensor of the scene file, if it has one."""
        found = self._core.sensor
        return None if found is None else Sensor(found)

    def simulator(
        self, sensor: Sensor | str | os.PathLike[str] | None = None, *, renderer: str = "embree", threads: int = 0
    ) -> Simulator:
        """What measures this scene with a sensor: the same one again when it was asked for before."""
        chosen = self._chosen(sensor)
        key = (id(chosen._core), renderer, threads)
        found = self._simulators.get(key)
        if found is None:
            found = Simulator(self, chosen, renderer=renderer, threads=threads)
            while len(self._simulators) >= _MOST_SIMULATORS:
                self._simulators.pop(next(iter(self._simulators)))
            self._simulators[key] = found
        return found

    def _chosen(self, sensor: Sensor | str | os.PathLike[str] | None) -> Sensor:
        if isinstance(sensor, Sensor):
            return sensor
        if sensor is not None:
            return load_sensor(sensor)
        own = self.sensor
        if own is None:
            raise Error("sensor", "the scene file has none", "a sensor", "glidar.camera() makes one")
        return own

    def __repr__(self) -> str:
        return f"<glidar.Scene of {len(self)} objects: {', '.join(o.name for o in self.objects[:4])}>"


def load_scene(path: str | os.PathLike[str], *, unit: str | float = "m", up: str | None = None) -> Scene:
    """The scene of a scene file, a model file, or "builtin:NAME"; as ``Scene(path)``."""
    return Scene(path, unit=unit, up=up)


def _metres(unit: str | float) -> float:
    if isinstance(unit, str):
        return _UNITS[one_of(unit, "unit", tuple(_UNITS))]
    return float(floats(unit, "unit", ()))


def _axis(up: str | None) -> int | None:
    return None if up is None else _AXES.index(one_of(up, "up", _AXES))


def _triangles(value: npt.ArrayLike, vertices: int) -> npt.NDArray[np.uint32]:
    given = np.asarray(value)
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in "iu" or len(given) == 0:
        found = f"an array {' x '.join(map(str, given.shape))} of {given.dtype}"
        raise Error("triangles", found, "indices of vertices, n x 3 whole numbers")
    if given.min() < 0 or given.max() >= vertices:
        raise Error("triangles", f"indices from {given.min()} to {given.max()}", f"0 to {vertices - 1}")
    return np.ascontiguousarray(given, dtype=np.uint32)


def _per_vertex(value: npt.ArrayLike | None, where: str, count: int, size: int) -> npt.NDArray[np.float32] | None:
    if value is None:
        return None
    return floats(value, where, (count, size)).astype(np.float32)


