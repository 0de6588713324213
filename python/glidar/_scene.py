# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Scenes: models and meshes with poses."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error, shown
from ._inputs import FloatArray, floats, log, numbers, one_of, path_of, text_of, whole
from ._mesh import Mesh, mesh_of
from ._object import SceneObject
from ._recipe import Recipe
from ._scene_data import SceneData
from ._sensor import Sensor, load_sensor, plain
from ._simulator import Simulator

_UNITS = dict(_core.length_units())
_AXES = ("x", "y", "z")
_Folders: TypeAlias = str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | None
_MAX_SIMULATORS = 8
_PLACING = ("pose", "scale", "name", "id", "class_name", "materials", "visible_to", "hidden_from")
_UNIT_TOLERANCE = 1e-3  # for normals that a file rounds to three digits


@dataclass(frozen=True, eq=False)
class ModelPart:
    """A part of a model file with all parts below it."""

    name: str
    """Its path, such as "arm/hand"; `parts` of ``Scene.add_parts`` and of scene files name it."""
    parent: str
    """Name of the part above it; empty: the file."""
    materials: list[str]
    triangles: int
    minimum: FloatArray
    """(3,), m: minimum corner of its box, in the model's frame."""
    maximum: FloatArray
    """(3,), m: maximum corner."""
    pose: FloatArray
    """(4, 4), m: parent_from_part, without scales of the file."""


class Scene(SceneData):
    """A scene: objects, each an instance of a model with a pose.

    Two scenes are equal when their objects, meshes, materials, motion and sensors are bit-identical, regardless of
    where they come from. Scenes are mutable and thus not hashable. A copy is independent, and shares memory with
    the original until one of them is changed. A pickled scene contains the paths of the files that it was read
    from, with hashes of their contents, and the arrays of meshes defined in code.

    Args:
        source: a scene file (.yaml, .yml), a model file, or "builtin:asteroid", "builtin:sphere",
            "builtin:box", "builtin:torus", "builtin:plane", optionally with sizes:
            "builtin:box:size=2,1,0.5", "builtin:sphere:radius=3"; None: an empty scene.
        unit: unit of a model file: "m", "cm", "mm", "in", "ft", or metres per unit; None: the unit that the file
            declares, else "m".
        up: the axis of a model file that becomes z: "x", "y", "z"; None: the axis that the file declares,
            else unchanged axes.
        centre: whether to move the centre of a model's bounding box to its origin.
        texture_folder: a folder, or a list of them, below which textures outside the model's folder are searched.

    Raises:
        Error: the file cannot be read, with line, column and field where known.
    """

    def __init__(
        self,
        source: str | os.PathLike[str] | None = None,
        *,
        unit: str | float | None = None,
        up: str | None = None,
        centre: bool = False,
        texture_folder: _Folders = None,
    ) -> None:
        options = _options(unit, up, centre, texture_folder)
        self._set_recipe(Recipe.empty() if source is None else _loaded(source, options))

    def _set_recipe(self, recipe: Recipe) -> None:
        """Makes every change of the scene release the simulators, which measure its earlier state."""
        self._recipe = recipe
        self._simulators: dict[tuple[int, str, int], Simulator] = {}
        recipe.before_change = self._simulators.clear

    @staticmethod
    def from_dict(description: Mapping[str, Any]) -> Scene:
        """A scene from the keys of a scene file (docs/files.md): models, sensor, sensor_pose ... Paths are relative
        to the working folder.

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

    __hash__ = None  # type: ignore[assignment]  # mutable

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
        texture_folder: _Folders = None,
        **placing: Any,
    ) -> SceneObject:
        """Adds a model file or "builtin:NAME"; returns its object.

        Args:
            unit, up, centre, texture_folder: as for ``Scene``.
            placing: pose (4, 4), scale (one factor, or three along the object's axes; negative ones mirror),
                name, id, class_name, materials, visible_to, hidden_from of the object.

        Raises:
            Error: the file cannot be read, or an argument is invalid; the scene is unchanged then.
        """
        index = self._recipe.add_model(path_of(source, "model"), _options(unit, up, centre, texture_folder))
        return self._initialised(index, placing)

    def add_parts(
        self,
        source: str | os.PathLike[str],
        *,
        parts: Mapping[str, Mapping[str, Any]] | None = None,
        split: str = "none",
        unit: str | float | None = None,
        up: str | None = None,
        centre: bool = False,
        texture_folder: _Folders = None,
        **placing: Any,
    ) -> tuple[SceneObject, ...]:
        """Adds a model of which parts become objects of their own; returns these objects. ``list_parts`` lists parts.

        Args:
            source: a model file or "builtin:NAME".
            parts: changes as ``parts`` in scene files (docs/files/parts.md), by a name, a pattern or
                "material:NAME", e.g. ``{"arm/*": {"class": "arm"}, "material:glass": {"hidden_from": ["lidar"]}}``;
                their `pose` may be an array (4, 4), parent_from_part.
            split: "parts" or "materials": each becomes an object with a consecutive id, and its name as class.
            unit, up, centre, texture_folder: as for ``Scene``.
            placing: pose (4, 4), scale, name, id, class_name, materials, visible_to, hidden_from of the model.

        Raises:
            Error: the file cannot be read, a part is unknown, or an argument is invalid; the scene is unchanged then.
        """
        one_of(split, "split", ("none", "parts", "materials"))
        entry = _model_entry(path_of(source, "model"), placing)
        model: str = entry["model"]
        stem = model.split(":")[1] if model.startswith("builtin:") else Path(model).stem
        register = self._recipe.register(len(self))
        entry.setdefault("name", register.free_names(stem, 1)[0])
        entry.setdefault("id", register.free_ids(len(self) + 1, 1)[0])
        entry["split"] = split
        if parts is not None and not isinstance(parts, Mapping):
            raise Error("parts", shown(parts), "a dict of changes by names of parts")
        if parts:
            entry["parts"] = {name: _part_entry(changes, name) for name, changes in parts.items()}
        first = len(self)
        text = json.dumps({"models": [plain(entry, "models[0]")]}, ensure_ascii=False)
        self._recipe.add_models(text, _options(unit, up, centre, texture_folder))
        return self.objects[first:]

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
        """Adds a mesh from arrays, or a mesh of this or another library; returns its object.

        Args:
            vertices: (V, 3), m, in the object's coordinate frame; or a ``Mesh``, or a mesh of trimesh or
                Open3D, without the other arrays.
            triangles: (T, 3), vertex indices, counter-clockwise when seen from the front.
            normals: (V, 3), unit vectors, or zeros for vertices without a normal; None: flat shading.
            uvs: (V, 2), texture coordinates, v upwards.
            colours: (V, 3), RGB from 0 to 1.
            placing: pose (4, 4), scale, name, id, class_name, materials, visible_to, hidden_from of the object.

        Raises:
            Error: a wrong shape, a number that is not finite, or a vertex index out of range.
        """
        if triangles is not None:
            mesh = Mesh(vertices, triangles, normals, uvs, colours)
        elif normals is None and uvs is None and colours is None:
            mesh = mesh_of(vertices)
        else:
            raise Error("mesh", "normals, uvs or colours are given with a mesh", "arrays, or only a mesh")
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
        return self._initialised(index, placing)

    def add_instance(self, of: SceneObject, **placing: Any) -> SceneObject:
        """Adds another instance of an object's mesh and materials, which needs no additional memory; returns it.

        Args:
            of: an object of this scene.
            placing: pose (4, 4), scale, name, id, class_name, materials, visible_to, hidden_from; default: those of
                the object.

        Raises:
            Error: `of` is not an object of this scene, or an argument is invalid; the scene is unchanged then.
        """
        self._require_own(of, "add_instance")
        return self._initialised(self._recipe.add_instance(of.index), placing)

    def _require_own(self, of: object, where: str) -> None:
        if not isinstance(of, SceneObject):
            raise Error(where, shown(of), "an object of this scene")
        if of._scene is not self:
            remedy = "scene.add_mesh(of.mesh) adds the mesh of another scene's object"
            raise Error(where, f"{of!r} belongs to another scene", "an object of this scene", remedy)

    def add_instances(self, of: SceneObject, poses: npt.ArrayLike) -> tuple[SceneObject, ...]:
        """Adds an instance of an object for each pose, in one step; returns them. They get the next free names and ids,
        and everything else from the object.

        Args:
            of: an object of this scene.
            poses: (N, 4, 4), world_from_object.

        Raises:
            Error: as for ``add_instance``, or a pose that is not rigid; the scene is unchanged then.
        """
        self._require_own(of, "add_instances")
        array = floats(poses, "poses", (None, 4, 4))
        first = len(self)
        register = self._recipe.register(first)
        names = register.free_names(of.name, len(array))
        ids = register.free_ids(first + 1, len(array))
        self._recipe.add_instances(of.index, array, names, ids)
        return tuple(SceneObject(self, index) for index in range(first, len(self)))

    def _initialised(self, index: int, placing: dict[str, Any]) -> SceneObject:
        """The object that was just added, with a unique name and id and the given attributes."""
        added = SceneObject(self, index)
        try:
            self._recipe.set_object(index, {
                "name": self._recipe.register(index).free_names(added.name, 1)[0],
                "id": self._recipe.register(index).free_ids(index + 1, 1)[0],
            })
            self._set_attributes(added, placing)
        except BaseException:
            self._recipe.drop_last()
            raise
        return added

    @staticmethod
    def _set_attributes(added: SceneObject, placing: dict[str, Any]) -> None:
        for name, value in placing.items():
            one_of(name, "argument", _PLACING)
            if value is None:
                continue
            if name == "materials":
                added.set_materials(value)
            else:
                setattr(added, name, value)

    @property
    def objects(self) -> tuple[SceneObject, ...]:
        """All objects, by index."""
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
        """A simulator of this scene with a sensor; returns the cached one for the same arguments."""
        chosen = self._chosen(sensor)
        key = (id(chosen._core), text_of(renderer, "renderer"), whole(threads, "threads", 4096))
        found = self._simulators.get(key)
        if found is None:
            found = Simulator(self, chosen, renderer=renderer, threads=threads)
            while len(self._simulators) >= _MAX_SIMULATORS:
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
            raise Error("sensor", f"the scene file has a rig of {len(self.rig)}", allowed, "simulate_rig measures with all of them")
        raise Error("sensor", "the scene file has no sensor", "a sensor", "glidar.camera() returns one")

    def __repr__(self) -> str:
        return f"<glidar.Scene of {len(self)} objects: {', '.join(o.name for o in self.objects[:4])}>"


def load_scene(
    path: str | os.PathLike[str],
    *,
    unit: str | float | None = None,
    up: str | None = None,
    centre: bool = False,
    texture_folder: _Folders = None,
) -> Scene:
    """The scene of a scene file, a model file, or "builtin:NAME"; the same as ``Scene(path)``."""
    return Scene(path, unit=unit, up=up, centre=centre, texture_folder=texture_folder)


def list_parts(
    source: str | os.PathLike[str], *, unit: str | float | None = None, up: str | None = None, centre: bool = False
) -> list[ModelPart]:
    """The named nodes, groups and objects of a model file, parents first; the same as ``glidar info --parts``.

    Args:
        source, unit, up, centre: as for ``Scene``.

    Raises:
        Error: the file cannot be read.
    """
    listed = _core.list_parts(path_of(source, "model"), _options(unit, up, centre, None), log)
    return [ModelPart(**part) for part in listed]


def _model_entry(path: str, placing: Mapping[str, Any]) -> dict[str, Any]:
    """The keys of one entry of `models` in scene files."""
    entry: dict[str, Any] = {"model": path}
    for name, value in placing.items():
        one_of(name, "argument", _PLACING)
        if value is not None:
            entry["class" if name == "class_name" else name] = _pose_keys(value, name) if name == "pose" else value
    return entry


def _part_entry(changes: Mapping[str, Any], name: str) -> dict[str, Any]:
    if not isinstance(changes, Mapping):
        raise Error(f"parts.{text_of(name, 'parts')}", shown(changes), "a dict of changes")
    return {key: _pose_keys(value, f"parts.{name}.pose") if key == "pose" else value for key, value in changes.items()}


def _pose_keys(pose: Any, where: str) -> Any:
    """A pose as in scene files, in which a matrix keeps every bit."""
    if isinstance(pose, Mapping):
        return pose
    matrix = floats(pose, where, (4, 4))
    if matrix[3].tolist() != [0, 0, 0, 1]:
        raise Error(where, f"the last row {shown(matrix[3].tolist())}", "0, 0, 0, 1")
    return {"matrix": matrix[:3].ravel()}


def _loaded(source: str | os.PathLike[str], options: dict[str, Any]) -> Recipe:
    """The recipe of a scene file, or of a scene of one model."""
    path = path_of(source, "scene")
    if path.endswith((".yaml", ".yml")):
        return Recipe.of_file(path, options)
    recipe = Recipe.empty()
    recipe.add_model(path, options)
    return recipe


def _options(unit: str | float | None, up: str | None, centre: bool, texture_folder: _Folders) -> dict[str, Any]:
    """Options for reading a model file, as the extension accepts them."""
    if not isinstance(centre, bool):
        raise Error("centre", shown(centre), "True or False")
    metres = None if unit is None else _metres(unit)
    folders = [] if texture_folder is None else texture_folder if isinstance(texture_folder, (list, tuple)) else [texture_folder]
    paths = [path_of(folder, "texture_folder") for folder in folders]
    if "" in paths:
        raise Error("texture_folder", "''", "a folder")
    absolute = [os.path.abspath(path) for path in paths]
    return {"metres_per_unit": metres, "up": _axis(up), "centre": centre, "texture_folders": absolute}


def _metres(unit: str | float) -> float:
    if isinstance(unit, str):
        return _UNITS[one_of(unit, "unit", tuple(_UNITS))]
    return float(floats(unit, "unit", ()))


def _axis(up: str | None) -> int | None:
    return None if up is None else _AXES.index(one_of(up.lower() if isinstance(up, str) else up, "up", _AXES))


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
    """Checks that normals are unit vectors or zeros."""
    if normals is None:
        return None
    lengths = np.linalg.norm(normals, axis=1)
    wrong = np.flatnonzero((np.abs(lengths - 1.0) > _UNIT_TOLERANCE) & (lengths != 0.0))
    if len(wrong):
        raise Error("normals", f"a vector of length {lengths[wrong[0]]:g} at [{wrong[0]}]", "unit vectors, or zeros")
    return normals


def _fractions(colours: _VertexArray) -> _VertexArray:
    """Checks that colours are from 0 to 1."""
    if colours is not None and (colours.min() < 0.0 or colours.max() > 1.0):
        remedy = "divide 8-bit colours by 255"
        raise Error("colours", f"numbers from {colours.min():g} to {colours.max():g}", "0 to 1", remedy)
    return colours


def surface_names() -> list[str]:
    """Names of the surface presets for `surface` of materials."""
    return _core.surface_names()
