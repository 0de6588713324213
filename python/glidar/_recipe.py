# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The steps that create a scene, so that another process can repeat them."""

from __future__ import annotations

import hashlib
import itertools
import os
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error
from ._inputs import log, one_of
from ._state import key_of, part, restoring, make_state

_BUILTIN = "builtin:"

#: A step: its name and its arguments.
Step = tuple[str, dict[str, Any]]
_STEPS = ("model", "models", "mesh", "copy", "copies", "drop", "set", "materials", "box_classes")


class _Register:
    """Names and ids of a scene's first objects, so that finding a free one does not take longer in large scenes."""

    def __init__(self, core: _core.Scene, count: int) -> None:
        self._objects: list[dict[str, Any]] = []
        self._count: dict[str, Counter[Any]] = {"name": Counter(), "id": Counter()}
        self._next_number: dict[str, int] = {}  # of a base name: all smaller ones are taken
        for index in range(count):
            self.set(index, core.object(index))

    def __len__(self) -> int:
        return len(self._objects)

    def set(self, index: int, info: dict[str, Any]) -> None:
        """Replaces the attributes of an object, or adds those of the next."""
        if index == len(self._objects):
            self._objects.append({})
        for key, count in self._count.items():
            if self._objects[index].get(key) == info[key]:
                continue
            self._give_up(index, key)
            self._objects[index][key] = info[key]
            count[info[key]] += 1

    def drop_last(self) -> None:
        """Removes the last object."""
        for key in self._count:
            self._give_up(len(self._objects) - 1, key)
        self._objects.pop()

    def _give_up(self, index: int, key: str) -> None:
        value = self._objects[index].get(key)
        if value is None:
            return
        self._count[key][value] -= 1
        if key == "name":
            base, _, number = value.rpartition("_")
            for freed, place in ((value, "1"), (base, number)):
                if freed in self._next_number and place.isdecimal() and place.isascii() and len(place) < 10:
                    self._next_number[freed] = min(self._next_number[freed], int(place))

    def is_taken(self, key: str, value: Any, index: int = -1) -> bool:
        """Whether an object other than this one has the name or id."""
        own = 0 <= index < len(self._objects) and self._objects[index][key] == value
        return self._count[key][value] > own

    def free_names(self, base: str, count: int) -> list[str]:
        """The first names of base, base_2, base_3 ... that no object has."""
        first = self._next_number.get(base, 1)
        numbered = ((n, base if n == 1 else f"{base}_{n}") for n in itertools.count(first))
        free = list(itertools.islice(((n, name) for n, name in numbered if not self.is_taken("name", name)), count))
        if free:
            self._next_number[base] = free[0][0]  # the caller may not use it
        return [name for _, name in free]

    def free_ids(self, least: int, count: int) -> list[int]:
        """The smallest ids from this one that no object has."""
        return list(itertools.islice((n for n in itertools.count(least) if not self.is_taken("id", n)), count))


class Recipe:
    """A scene and the steps that created it. Every change of the scene is made through its recipe.

    Changes of one object's attributes are merged, so that moving an object a million times is one step.
    """

    def __init__(self, core: _core.Scene, steps: list[Step]) -> None:
        self.core = core
        self._steps = steps
        self._latest: dict[int, dict[str, Any]] = {}  # the last changes of each object, which later ones may join
        self._files: dict[str, str] = {}  # names of the files that were read, and their absolute paths
        self._register: _Register | None = None  # of all objects, or all but the last one
        self.before_change: Callable[[], object] | None = None  # releases what depends on the scene as it is
        self._note_files()

    def _note_files(self) -> None:
        """Relative names refer to the current working folder, which may change later."""
        for name in self.core.files:
            self._files.setdefault(name, os.path.abspath(name))

    @staticmethod
    def empty() -> Recipe:
        """The recipe of a scene without objects."""
        return Recipe(_core.Scene(), [])

    @staticmethod
    def of_file(path: str, options: dict[str, Any]) -> Recipe:
        """The recipe of a scene file; the options apply to its models."""
        core = _core.load_scene(path, options, log)
        return Recipe(core, [("scene_file", {"path": path, "folder": _working_folder(), "options": options})])

    @staticmethod
    def of_content(content: str, path: str) -> Recipe:
        """The recipe of a scene file with this content."""
        core = _core.load_scene_content(path, content, log)
        return Recipe(core, [("scene", {"text": content, "folder": os.path.dirname(os.path.abspath(path))})])

    @staticmethod
    def of_text(text: str, folder: str = "") -> Recipe:
        """The recipe of the keys of a scene file; paths are relative to the folder, or to the working folder."""
        core = _core.parse_scene(text, log, folder)
        return Recipe(core, [("scene", {"text": text, "folder": folder or _working_folder()})])

    def copy(self) -> Recipe:
        """An independent copy, which shares memory until one of the two is changed."""
        steps = [
            (name, {**given, "changes": dict(given["changes"])} if name == "set" else given)
            for name, given in self._steps
        ]
        copied = Recipe(_core.copy_scene(self.core), steps)
        copied._files = dict(self._files)
        return copied

    def _editable(self) -> _core.Scene:
        """The scene, after releasing what depends on its present state."""
        if self.before_change is not None:
            self.before_change()
        return self.core

    def register(self, count: int) -> _Register:
        """Names and ids of the first objects of the scene."""
        if self._register is None or len(self._register) != count:
            self._register = _Register(self.core, count)
        return self._register

    def _add(self, name: str, **arguments: Any) -> None:
        self._steps.append((name, arguments))
        self._latest.clear()

    def add_model(self, path: str, options: dict[str, Any]) -> int:
        """Adds a model file or a built-in model; returns its index."""
        index = self._editable().add_model(path, options, log)
        self._add("model", path=path, folder=_working_folder(), options=options)
        self._note_files()
        return index

    def add_models(self, text: str, options: dict[str, Any], folder: str = "") -> None:
        """Adds models by the keys of a scene file; paths are relative to the folder, or to the working folder."""
        self._editable().add_models(text, options, log, folder)
        self._add("models", text=text, folder=folder or _working_folder(), options=options)
        self._note_files()

    def add_mesh(self, name: str, arrays: dict[str, Any]) -> int:
        """Adds a mesh from arrays; returns its index. The step refers to the arrays in the scene."""
        index = self._editable().add_mesh(name, arrays)
        self._add("mesh", mesh=_core.loaded_mesh_count(self.core) - 1)
        return index

    def add_instances(self, of: int, poses: npt.NDArray[np.float64], names: list[str], ids: list[int]) -> None:
        """Adds further instances of an object's mesh; poses (N, 4, 4)."""
        first = len(self.core)
        self._editable().add_instances(of, poses, names, ids)
        self._add("copies", of=of, poses=np.array(poses), names=names, ids=ids)
        if self._register is not None and len(self._register) == first:
            for index, (name, number) in enumerate(zip(names, ids)):
                self._register.set(first + index, {"name": name, "id": number})

    def add_instance(self, of: int) -> int:
        """Adds another instance of an object's mesh; returns its index."""
        index = self._editable().add_instance(of)
        self._add("copy", of=of)
        return index

    def drop_last(self) -> None:
        """Removes the last object."""
        self._editable().drop_last()
        self._add("drop")
        if self._register is not None and len(self._register) > len(self.core):
            self._register.drop_last()

    def set_object(self, index: int, changes: dict[str, Any]) -> None:
        """Sets attributes of an object."""
        self._editable().set_object(index, changes)
        if self._register is not None and index <= len(self._register) and ("name" in changes or "id" in changes):
            self._register.set(index, self.core.object(index))
        kept = {name: np.array(value) if isinstance(value, np.ndarray) else value for name, value in changes.items()}
        if index in self._latest:
            self._latest[index].update(kept)
            return
        self._steps.append(("set", {"index": index, "changes": kept}))
        self._latest[index] = kept

    def set_materials(self, index: int, text: str, folder: str = "") -> None:
        """Changes materials of an object; paths are relative to the folder, or to the working folder."""
        self._editable().set_materials(index, text, folder)
        arguments = {"index": index, "text": text, "folder": folder or _working_folder()}
        self._steps.append(("materials", arguments))

    def set_box_classes(self, names: list[str]) -> None:
        """Sets the classes whose objects have boxes."""
        self._editable().set_box_classes(names)
        self._steps.append(("box_classes", {"names": names}))

    def key(self) -> object:
        """A hashable value that is equal for scenes with bit-identical measurements."""
        sensors = [(name, core.values(), core.beam_table(), pose) for name, core, pose in self.core.rig()]
        imus = [(name, core.document(), pose) for name, core, pose in self.core.imus()]
        parts = [_core.scene_digest(self.core), _core.placing_state(self.core), sensors]
        return key_of([*parts, imus, self.core.gravity_m_s2, self.core.box_classes])

    def digest(self) -> str:
        """A hash of the key."""
        return hashlib.sha256(repr(self.key()).encode()).hexdigest()

    def state(self) -> dict[str, Any]:
        """The state to pickle: steps, arrays of meshes, hashes of files."""
        steps: list[Step] = []
        for name, arguments in self._steps:
            if name == "mesh":
                arguments = {"state": _core.mesh_state(self.core, arguments["mesh"])}
            steps.append((name, arguments))
        files = {name: _hash_of(name) for name in self._files.values() if not _is_preset(name)}
        return make_state("Scene", steps=steps, files=files, classes=self.core.class_names, digest=self.digest())

    @staticmethod
    def restored(state: dict[str, Any]) -> Recipe:
        """The recipe of a pickled scene.

        Raises:
            Error: a file is missing or has changed, or the steps create another scene.
        """
        with restoring("Scene", state):
            return Recipe._replayed(state)

    @staticmethod
    def _replayed(state: dict[str, Any]) -> Recipe:
        for name, known in part(state, "files", dict).items():
            _require_unchanged(name, known)
        recipe = Recipe.empty()
        steps = part(state, "steps", list)
        if steps and steps[0][0] in ("scene_file", "scene"):
            recipe = _restored_base(*steps[0])
            steps = steps[1:]
        _core.add_classes(recipe.core, part(state, "classes", list))
        for name, arguments in steps:
            recipe._replay(name, arguments)
        if recipe.digest() != state["digest"]:
            raise Error(
                "pickled Scene",
                "its files and steps make another scene than the one that was pickled",
                "",
                "a file had changed before it was pickled, or another version of glidar wrote it: pickle it again",
            )
        return recipe

    def _replay(self, name: str, arguments: dict[str, Any]) -> None:
        one_of(name, "pickled Scene, step", _STEPS)
        if name == "model":
            self.add_model(_resolved_path(arguments), part(arguments, "options", dict))
        elif name == "models":
            self.add_models(part(arguments, "text", str), part(arguments, "options", dict), _folder(arguments))
        elif name == "mesh":
            self.core.restore_mesh(_plain_arrays(part(arguments, "state", dict)))
            self._add("mesh", mesh=_core.loaded_mesh_count(self.core) - 1)
        elif name == "copy":
            self.add_instance(self._checked_index(arguments["of"]))
        elif name == "copies":
            of, poses = self._checked_index(arguments["of"]), np.ascontiguousarray(part(arguments, "poses", np.ndarray))
            self.add_instances(of, poses, part(arguments, "names", list), part(arguments, "ids", list))
        elif name == "drop":
            self.drop_last()
        elif name == "box_classes":
            self.set_box_classes(part(arguments, "names", list))
        elif name == "set":
            self.set_object(self._checked_index(arguments["index"]), part(arguments, "changes", dict))
        else:
            self.set_materials(self._checked_index(arguments["index"]), part(arguments, "text", str), _folder(arguments))

    def _checked_index(self, index: int) -> int:
        if not 0 <= index < len(self.core):
            raise IndexError(f"object {index} of {len(self.core)}")
        return index


def _restored_base(name: str, arguments: dict[str, Any]) -> Recipe:
    if name == "scene":
        return Recipe.of_text(part(arguments, "text", str), _folder(arguments))
    return Recipe.of_file(_resolved_path(arguments), part(arguments, "options", dict))


def _working_folder() -> str:
    """The folder of relative paths; empty when it was deleted, so that no relative path is valid."""
    try:
        return os.getcwd()
    except FileNotFoundError:
        return ""


def _folder(arguments: dict[str, Any]) -> str:
    """The folder of a step's relative paths; empty when it is the working folder."""
    folder = part(arguments, "folder", str)
    return "" if folder == _working_folder() else folder


def _resolved_path(arguments: dict[str, Any]) -> str:
    """The path of a step, relative to its folder unless that is the working folder."""
    path = part(arguments, "path", str)
    return path if path.startswith(_BUILTIN) else str(Path(_folder(arguments), path))


def _plain_arrays(mesh: dict[str, Any]) -> dict[str, Any]:
    """The arrays of a mesh, contiguous, because the library reads their memory directly."""
    return {
        name: np.ascontiguousarray(value) if isinstance(value, np.ndarray) else value for name, value in mesh.items()
    }


def _is_preset(name: str) -> bool:
    """Presets have other paths on another machine; the digest of the scene shows whether they differ."""
    return os.path.dirname(name) == os.fspath(_core.sensor_folder())


def _hash_of(name: str) -> str:
    found = _core.hash_file(name)
    if found is None:
        raise Error(name, "the scene was read from this file, which is missing now", "", "restore the file to pickle the scene")
    return found


def _require_unchanged(name: str, known: str | None) -> None:
    found = _core.hash_file(name)
    if found is None:
        remedy = "a pickled scene contains the paths of its files: provide the file there, on this machine too"
        raise Error(name, "the pickled scene was read from this file, which is missing", "", remedy)
    if found != known:
        remedy = "pickle the scene again, or restore the earlier file"
        raise Error(name, f"the file has changed since the scene was pickled (hash {found})", f"hash {known}", remedy)
