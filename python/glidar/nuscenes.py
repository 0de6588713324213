# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Data sets in the format of nuScenes, which nuscenes-devkit reads:

    from glidar.nuscenes import NuscenesWriter

    with NuscenesWriter("nuscenes") as data:
        data.add_scene(glidar.Scene("examples/drive.yaml"), duration_s=20.0)

or on the command line ``python3 -m glidar.nuscenes examples/drive.yaml -o nuscenes --duration 20``.
docs/files/nuscenes.md describes the files.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType

from . import _core
from . import _nuscenes_tables as tables
from ._errors import Error, shown
from ._inputs import MAX_UINT64, floats, path_of, whole
from ._nuscenes_scene import SceneWriter, channels_of
from ._nuscenes_tables import token
from ._printing import print_line, print_message
from ._scene import Scene, load_scene
from ._scene_data import not_a_scene
from ._trajectory import PoseLike, trajectories

START_US = 1_577_836_800_000_000  # 2020-01-01


class NuscenesWriter:
    """Writes a data set of one or more scenes. The folder appears when it is complete: by ``close``, or at the end of a
    ``with`` block. If that ends by an exception, nothing remains.

    Args:
        folder: the data set's root; created, or an empty folder.
        version: name of the folder of tables, such as "v1.0-mini"; the devkit's splits depend on it.
        categories: nuScenes' category of each class that has another name; added to those of docs/files/nuscenes.md.
        start_us: time of the first frame of the first scene, µs since 1970; scenes follow each other. None: the dates
            of scenes whose trajectories have them; others follow each other from 2020-01-01 on.

    Raises:
        Error: a folder that is not empty, or an argument of another type.
    """

    def __init__(
        self,
        folder: str | os.PathLike[str],
        *,
        version: str = "v1.0-mini",
        categories: Mapping[str, str] | None = None,
        start_us: int | None = None,
    ) -> None:
        self._root = Path(path_of(folder, "folder"))
        if self._root.exists() and (not self._root.is_dir() or any(self._root.iterdir())):
            raise Error(str(self._root), "it is not an empty folder", "a new or empty folder", "choose another name")
        self._version = version
        self._categories = tables.CATEGORIES | dict(categories or {})
        self._keeps_dates = start_us is None
        self._next_us = START_US if start_us is None else whole(start_us, "start_us", MAX_UINT64)
        self._tables = tables.fixed_tables()
        self._indices = {"noise": 0}  # of categories, in lidarseg files
        self._scenes: set[str] = set()
        self._folder = self._root.resolve()
        self._root = self._folder.with_name(f".{self._folder.name}.{os.getpid()}.tmp")
        shutil.rmtree(self._root, ignore_errors=True)
        self._root.mkdir(parents=True)

    def __enter__(self) -> NuscenesWriter:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        try:
            if kind is None:
                self.close()
        finally:
            shutil.rmtree(self._root, ignore_errors=True)

    def add_scene(
        self,
        scene: Scene,
        *,
        duration_s: float,
        name: str | None = None,
        trajectory: PoseLike | None = None,
        seed: int = 1,
        channels: Mapping[str, str] | None = None,
        renderer: str = "auto",
        threads: int = 0,
    ) -> str:
        """Measures a scene with all sensors of its file, and writes their frames.

        Args:
            scene: a scene file with a rig of sensors, or one sensor. The rig is nuScenes' ego vehicle.
            duration_s: frames that start before this time are written, s.
            name: of the scene; None: "scene-0001" and so on.
            trajectory: of the rig: world_from_rig; None: that of the scene file.
            seed: of all random numbers. The same seed gives the same bytes.
            channels: nuScenes' channel of each sensor, by its name on the rig; None: the first LiDAR is LIDAR_TOP
                and the first camera CAM_FRONT, others have their own names.
            renderer, threads: as for ``glidar.simulate``.

        Returns:
            The token of the scene.

        Raises:
            Error: a scene without a LiDAR, a trajectory or classes, or a name in use.
        """
        if not isinstance(scene, Scene):
            raise not_a_scene(scene)
        title = name if name is not None else f"scene-{len(self._scenes) + 1:04}"
        if title in self._scenes:
            raise Error("name", shown(title), "a name that no scene of the data set has")
        length = float(floats(duration_s, "duration_s", ()))
        if length <= 0.0:
            raise Error("duration_s", f"{length:g} s", "a time above 0")
        rig = scene._core.rig_motion() if trajectory is None else trajectories(trajectory, "trajectory")
        if rig is None:
            raise Error("trajectory", "the scene file places no rig", "a trajectory", "add rig_pose and rig_motion to the file")
        categories = {one: self._category(one) for one in scene.class_names}
        writer = SceneWriter(self._root, self._version, title, whole(seed, "seed", MAX_UINT64), self._next_us,
                             self._keeps_dates, rig, categories, self._indices, self._tables)  # fmt: skip
        writer.write(scene, channels_of(scene, channels or {}, renderer, threads), length)
        self._scenes.add(title)
        self._next_us += round(length * 1e6)
        return token("scene", title)

    def _category(self, name: str) -> str:
        category = self._categories.get(name, name)
        self._indices.setdefault(category, len(self._indices))
        return category

    def close(self) -> None:
        """Writes the tables, and gives the folder its name.

        Raises:
            Error: there is no scene, or the folder was made or filled meanwhile.
        """
        if not self._scenes:
            raise Error(str(self._folder), "it has no scene", "at least one scene", "call add_scene")
        for name, index in self._indices.items():
            self._tables["category"].append({"token": token("category", name), "name": name, "description": "", "index": index})
        has_colours = set(self._indices) <= set(tables.KNOWN_CATEGORIES)
        written = [name for name in tables.NAMES if name != "lidarseg" or has_colours]
        (self._root / self._version).mkdir(exist_ok=True)
        for name in written:
            text = json.dumps(self._tables[name], indent=0)
            _core.write_file(str(self._root / self._version / f"{name}.json"), f"{text}\n".encode())
        try:
            self._root.rename(self._folder)  # replaces an empty folder
        except OSError as error:
            raise Error(str(self._folder), f"{error.strerror}", "a new or empty folder", "choose another name") from error


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python3 -m glidar.nuscenes", description="Write a nuScenes data set",
                                     epilog="The rig of each scene file moves as the file specifies.")  # fmt: skip
    parser.add_argument("scenes", nargs="+", metavar="SCENE", help="scene file with a rig; each becomes a scene")
    parser.add_argument("-o", "--output", required=True, metavar="FOLDER", help="new folder of the data set")
    parser.add_argument("--duration", type=float, default=20.0, metavar="S", help="length of each scene, s [20]")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="seed of all random numbers [1]")
    parser.add_argument("--version", default="v1.0-mini", metavar="NAME", help="folder of the tables [v1.0-mini]")
    parser.add_argument("--category", action="append", default=[], metavar="CLASS=NAME",
                        help="nuScenes' category of a class, repeatable, such as van=vehicle.car")  # fmt: skip
    return parser


def _categories(texts: Sequence[str]) -> dict[str, str]:
    pairs = [text.partition("=") for text in texts]
    for name, equals, category in pairs:
        if not (name and equals and category):
            raise Error("--category", shown(f"{name}{equals}{category}"), "CLASS=NAME, such as van=vehicle.car")
    return {name: category for name, _, category in pairs}


def _check_classes(categories: Mapping[str, str], paths: Sequence[str]) -> None:
    """Raises Error for a class that no scene has."""
    if not categories:
        return
    known = {name: None for path in paths for name in load_scene(path).class_names}
    for name in categories:
        if name not in known:
            raise Error("--category", shown(name), f"classes of the scenes: {', '.join(known)}", "correct it or leave it out")


def main(arguments: Sequence[str] | None = None) -> int:
    """The command line; returns the exit code."""
    given = _parser().parse_args(arguments)
    try:
        categories = _categories(given.category)
        _check_classes(categories, given.scenes)
        with NuscenesWriter(given.output, version=given.version, categories=categories) as data:
            for path in given.scenes:
                data.add_scene(load_scene(path), duration_s=given.duration, seed=given.seed)
    except Error as error:
        print_message(f"glidar.nuscenes: {error}")
        return 2
    except KeyboardInterrupt:
        print_message("glidar.nuscenes: interrupted; nothing was written")
        return 130
    print_line(f"wrote {given.output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
