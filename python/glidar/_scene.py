# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Scenes: models and meshes, placed."""

from __future__ import annotations

import itertools
import json
import os
from collections.abc import Iterator, Mapping
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error, shown
from ._inputs import floats, numbers, one_of, path_of, text_of, whole
from ._mesh import Mesh, mesh_of
from ._object import SceneObject
from ._recipe import Recipe
from ._scene_data import SceneData
from ._sensor import Sensor, load_sensor, plain
from ._simulator import Simulator

_UNITS = {"mm": 0.001, "cm": 0.01, "m": 1.0, "in": 0.0254}
_AXES = ("x", "y", "z")
_MOST_SIMULATORS = 8
_UNIT_TOLERANCE = 1e-3  # of what was rounded to three digits in a file


class Scene(SceneData):
    """All there is to see: models, each placed as an object.

    Two scenes are equal when they have the same objects, meshes, materials, motion and sensors, to the
    last bit, wherever they come from. A scene cannot be hashed, because it can be changed. A copy can be
    changed apart from the original and shares its memory until then. A pickled scene names the files it
    was read from, with hashes of their contents, and holds the arrays of meshes made in code.

    Args:
        source: a scene file (.yaml, .yml), a model file, or "builtin:asteroid", "builtin:sphere",
            "builtin:box", "builtin:torus", "builtin:plane", with sizes if wanted:
            "builtin:box:size=2,1,0.5", "builtin:sphere:radius=3"; None: an empty scene.
        unit: of a model file's numbers: "m", "cm", "mm", "in", or metres per unit; None: what the file
            declares, else "m".
        up: the axis of a model file that becomes z: "x", "y", "z"; None: what the file declares, else
            axes as in the file.
        centre: move the middle of a model's box to its origin.

    Raises:
        Error: the file cannot be read, with line, column and field where it has them.
    """

    def __init__(
        self,
        source: str | os.PathLike[str] | None = None,
        *,
        unit: str | float | None = None,
        up: str | None = None,
        centre: bool = False,
    ) -> None:
        self._set_recipe(Recipe.empty() if source is None else _loaded(source, _options(unit, up, centre)))

    def _set_recipe(self, recipe: Recipe) -> None:
        """Every change of the recipe's scene releases the simulators, which measure the scene before it."""
        self._recipe = recipe
        self._simulators: dict[tuple[int, str, int], Simulator] = {}
        recipe.before_change = self._simulators.clear

    @staticmethod
    def from_dict(description: Mapping[str, Any]) -> Scene:
        """A scene of the keys of a scene file (docs/files.md): models, sensor, sensor_pose ... Paths count
        from the working folder.

        Raises:
            Error: names the field, what is allowed and the nearest known key.
        """
        return Scene._from_recipe(Recipe.of_text(json.dumps(plain(description, "scene"), ensure_ascii=False)))

    @staticmethod
    def _from_recipe(recipe: Recipe) -> Scene:
        scene = Scene.__new__(Scene)
        scene._set_recipe(recipe)
        return scene

    def __copy__(self) -> Scene:
        return Scene._from_recipe(self._recipe.copy())

    def __deepcopy__(self, memo: dict[int, Any]) -> Scene:
        return self.__copy__()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return self is other or self._recipe.key() == other._recipe.key()

    __hash__ = None  # type: ignore[assignment]  # it can be changed

    def __getstate__(self) -> dict[str, Any]:
        return self._recipe.state()

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._set_recipe(Recipe.restored(state))

    def add_model(
        self,
        source: str | os.PathLike[str],
        *,
        unit: str | float | None = None,
        up: str | None = None,
        centre: bool = False,
        **placing: Any,
    ) -> SceneObject:
        """Adds a model file or "builtin:NAME".

        Args:
            unit, up, centre: as for ``Scene``.
            placing: pose (4x4), scale (one factor, or three along the object's own axes), name, id,
                class_name, materials of the object.
        """
        index = self._recipe.add_model(path_of(source, "model"), _options(unit, up, centre))
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
    ) -> SceneObject:
        """Adds a mesh from arrays, or from what this and other libraries call a mesh.

        Args:
            vertices: (V, 3), m, in the object's own frame; or a ``Mesh``, or a mesh of trimesh or
                Open3D, without the rest.
            triangles: (T, 3), indices of vertices, counter-clockwise seen from the front.
            normals: (V, 3), unit vectors, or zeros where there is none; None: flat shading.
            uvs: (V, 2), v upwards.
            colours: (V, 3), rgb 0..1.
            placing: pose (4x4), scale, name, id, class_name, materials of the object.

        Raises:
            Error: a wrong shape, a number that is not finite, an index of no vertex.
        """
        if triangles is not None:
            mesh = Mesh(vertices, triangles, normals, uvs, colours)
        elif normals is None and uvs is None and colours is None:
            mesh = mesh_of(vertices)
        else:
            raise Error("mesh", "normals, uvs or colours are given beside it", "arrays, or a mesh alone")
        corners = floats(mesh.vertices, "vertices", (None, 3))
        count = len(corners)
        arrays = {
            "vertices": corners,
            "triangles": _triangles(mesh.triangles, count),
            "normals": _unit(_per_vertex(mesh.normals, "normals", count, 3)),
            "uvs": _per_vertex(mesh.uvs, "uvs", count, 2),
            "colours": _fractions(_per_vertex(mesh.colours, "colours", count, 3)),
        }
        index = self._recipe.add_mesh(text_of(placing.get("name") or "mesh", "name"), arrays)
        return self._placed(index, placing)

    def add_instance(self, of: SceneObject, **placing: Any) -> SceneObject:
        """Adds another object with the mesh and materials of one that is there; costs no memory.

        Args:
            placing: pose (4x4), scale, name, id, class_name, materials; as those of the first when not given.
        """
        if not isinstance(of, SceneObject):
            raise Error("copy", shown(of), "an object of this scene")
        if of._scene is not self:
            remedy = "scene.add_mesh(of.mesh) takes the mesh of another scene's"
            raise Error("copy", f"{of!r} is of another scene", "an object of this scene", remedy)
        return self._placed(self._recipe.add_instance(of.index), placing)

    def _placed(self, index: int, placing: dict[str, Any]) -> SceneObject:
        """The object just added, with what is given of it, a name of its own and a number."""
        made = SceneObject(self, index)
        try:
            self._recipe.set_object(index, {"name": self._free_name(made.name), "id": self._free_id(index)})
            self._place(made, placing)
        except BaseException:
            self._recipe.drop_last()
            raise
        return made

    def _free_name(self, base: str) -> str:
        taken = {other.name for other in self.objects[:-1]}
        numbered = (f"{base}_{n}" for n in itertools.count(2))
        return next(name for name in itertools.chain([base], numbered) if name not in taken)

    def _free_id(self, index: int) -> int:
        taken = {other.id for other in self.objects[:-1]}
        return next(number for number in itertools.count(index + 1) if number not in taken)

    @staticmethod
    def _place(made: SceneObject, placing: dict[str, Any]) -> None:
        for name, value in placing.items():
            one_of(name, "argument", ("pose", "scale", "name", "id", "class_name", "materials"))
            if value is None:
                continue
            if name == "materials":
                made.set_materials(value)
            else:
                setattr(made, name, value)

    @property
    def objects(self) -> tuple[SceneObject, ...]:
        """All objects, in order."""
        return tuple(SceneObject(self, index) for index in range(len(self._core)))

    def __getitem__(self, name: str) -> SceneObject:
        for candidate in self.objects:
            if candidate.name == name:
                return candidate
        raise Error("object", shown(name), ", ".join(o.name for o in self.objects) or "the scene is empty")

    def __len__(self) -> int:
        return len(self._core)

    def __iter__(self) -> Iterator[SceneObject]:
        return iter(self.objects)

    def simulator(
        self, sensor: Sensor | str | os.PathLike[str] | None = None, *, renderer: str = "auto", threads: int = 0
    ) -> Simulator:
        """What measures this scene with a sensor: the same one again when it was asked for before."""
        chosen = self._chosen(sensor)
        key = (id(chosen._core), text_of(renderer, "renderer"), whole(threads, "threads", 4096))
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
        if own is not None:
            return own
        if self.rig:
            allowed = "one of scene.rig: " + ", ".join(self.rig)
            raise Error("sensor", f"the scene file has a rig of {len(self.rig)}", allowed, "simulate_rig takes all")
        raise Error("sensor", "the scene file has none", "a sensor", "glidar.camera() makes one")

    def __repr__(self) -> str:
        return f"<glidar.Scene of {len(self)} objects: {', '.join(o.name for o in self.objects[:4])}>"


def load_scene(
    path: str | os.PathLike[str], *, unit: str | float | None = None, up: str | None = None, centre: bool = False
) -> Scene:
    """The scene of a scene file, a model file, or "builtin:NAME"; as ``Scene(path)``."""
    return Scene(path, unit=unit, up=up, centre=centre)


def _loaded(source: str | os.PathLike[str], options: dict[str, Any]) -> Recipe:
    """The recipe of a scene file, or of a scene of one model."""
    path = path_of(source, "scene")
    if path.endswith((".yaml", ".yml")):
        return Recipe.of_file(path, options)
    recipe = Recipe.empty()
    recipe.add_model(path, options)
    return recipe


def _options(unit: str | float | None, up: str | None, centre: bool) -> dict[str, Any]:
    """How a model file is read, as the extension takes it."""
    if not isinstance(centre, bool):
        raise Error("centre", shown(centre), "True or False")
    metres = None if unit is None else _metres(unit)
    return {"metres_per_unit": metres, "up": _axis(up), "centre": centre}


def _metres(unit: str | float) -> float:
    if isinstance(unit, str):
        return _UNITS[one_of(unit, "unit", tuple(_UNITS))]
    return float(floats(unit, "unit", ()))


def _axis(up: str | None) -> int | None:
    return None if up is None else _AXES.index(one_of(up, "up", _AXES))


def _triangles(value: npt.ArrayLike, vertices: int) -> npt.NDArray[np.uint32]:
    given = numbers(value, "triangles", (None, 3))
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


_VertexArray: TypeAlias = npt.NDArray[np.float32] | None


def _unit(normals: _VertexArray) -> _VertexArray:
    """Unit vectors, or zeros."""
    if normals is None:
        return None
    lengths = np.linalg.norm(normals, axis=1)
    wrong = np.flatnonzero((np.abs(lengths - 1.0) > _UNIT_TOLERANCE) & (lengths != 0.0))
    if len(wrong):
        raise Error("normals", f"a vector of length {lengths[wrong[0]]:g} at [{wrong[0]}]", "unit vectors, or zeros")
    return normals


def _fractions(colours: _VertexArray) -> _VertexArray:
    """Numbers from 0 to 1."""
    if colours is not None and (colours.min() < 0.0 or colours.max() > 1.0):
        remedy = "divide by 255 what counts to there"
        raise Error("colours", f"numbers from {colours.min():g} to {colours.max():g}", "0 to 1", remedy)
    return colours


def surface_names() -> list[str]:
    """Names of the surfaces that come along, for `surface` of materials."""
    return _core.surface_names()
