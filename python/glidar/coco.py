# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Data sets in the format of COCO, which pycocotools reads: images with a mask and a box of each object.

    from glidar.coco import CocoWriter

    with CocoWriter("coco", scene, camera) as data:
        for pose in poses:
            data.add_image(pose)
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import struct
import weakref
import zlib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import Error, shown
from ._frame import Frame
from ._inputs import MAX_UINT64, path_of, text_list, whole
from ._scene import Scene
from ._scene_data import not_a_scene
from ._sensor import Sensor, load_sensor
from ._simulate import simulate

_INTRINSICS = ("fx", "fy")
_CENTRES = ("cx", "cy")
_MAX_RAYS = 1 << 21  # that are measured together


class CocoWriter:
    """Writes images of a camera with annotations of the visible objects. The folder appears when it is complete: by
    ``close``, or at the end of a ``with`` block. If one of them fails, or neither is reached, nothing remains.

    Args:
        folder: the data set's root; it must not exist.
        scene: whose objects have classes, the categories.
        sensor: a camera with a pinhole; None: that of the scene file.
        classes: of the objects with annotations; None: those with boxes (docs/boxes.md).
        supersampling: rays per pixel in each direction for colours, 1 to 16, which keeps thin structures from becoming speckle.

    Raises:
        Error: a folder that exists or that another writer is filling, a scene without classes, or a sensor that is no pinhole camera.
    """

    def __init__(
        self,
        folder: str | os.PathLike[str],
        scene: Scene,
        sensor: Sensor | str | os.PathLike[str] | None = None,
        *,
        classes: Iterable[str] | None = None,
        supersampling: int = 4,
    ) -> None:
        if not isinstance(scene, Scene):
            raise not_a_scene(scene)
        self._folder = Path(path_of(folder, "folder")).resolve()
        if self._folder.exists():
            raise Error(str(self._folder), "it exists", "a new folder", "choose another name")
        if len(scene.class_names) < 2:
            raise Error("scene", "no object has a class", "objects with classes, the categories", "set class_name of objects")
        self._scene = scene
        self._sensor = scene._chosen(sensor) if not isinstance(sensor, (str, os.PathLike)) else load_sensor(sensor)
        self._factor = whole(supersampling, "supersampling", 16)
        if self._factor == 0:
            raise Error("supersampling", "0", "1 to 16")
        self._described = _pinhole(self._sensor)
        self._classes = None if classes is None else text_list(classes, "classes")
        self._images: list[dict[str, Any]] = []
        self._annotations: list[dict[str, Any]] = []
        self._root = self._folder.with_name(f".{self._folder.name}.{os.getpid()}.tmp")
        made = [self._root, *(parent for parent in self._root.parents if not parent.exists())]
        self._root.parent.mkdir(parents=True, exist_ok=True)
        try:
            self._root.mkdir()
        except FileExistsError:
            raise Error(str(self._folder), "another writer makes it", "one writer of a folder", "choose another name") from None
        self._remove = weakref.finalize(self, _remove_folders, made)
        (self._root / "images").mkdir()

    def __enter__(self) -> CocoWriter:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if kind is None:
            self.close()
        self._remove()

    def add_image(self, pose: npt.ArrayLike | None = None, *, objects: npt.ArrayLike | None = None, seed: int = 1) -> int:
        """Measures the scene and adds an image; returns its number, from 1.

        Args:
            pose, objects: as for ``glidar.simulate``.
            seed: of the camera's noise, which only affects which pixels are measured; masks are ground truth.
        """
        if not self._remove.alive:
            raise Error(str(self._folder), "the writer is closed", "an open writer", "write to another folder")
        number = len(self._images) + 1
        frame = simulate(self._scene, self._sensor, pose=pose, objects=objects, seed=whole(seed, "seed", MAX_UINT64))
        pose = frame.world_from_sensor if pose is None else pose  # not one that is chosen for a band
        colours = []
        for band in _bands(self._described, frame.rows, frame.cols, self._factor):
            fine = simulate(self._scene, band, pose=pose, objects=objects, columns=["colour", "incidence"])
            colours.append(_colours(fine, self._factor))
        name = f"{number:06}.png"
        (self._root / "images" / name).write_bytes(_png(np.concatenate(colours)))
        self._images.append({"id": number, "file_name": name, "width": frame.cols, "height": frame.rows})
        categories = {name: index for index, name in enumerate(self._scene.class_names)}
        instances = frame.ground_truth.instance
        for box in frame.boxes(classes=self._classes):
            mask = instances == box.index
            if mask.any():
                self._annotations.append(
                    {"id": len(self._annotations) + 1, "image_id": number, "category_id": categories[box.class_name],
                     "iscrowd": 0, **_region(mask), "object_id": box.id, "name": box.name, "occlusion": box.occlusion})  # fmt: skip
        return number

    def close(self) -> None:
        """Writes annotations.json, and gives the folder its name. Nothing happens if it is closed.

        Raises:
            Error: there is no image, or the folder was made meanwhile.
        """
        if not self._remove.alive:
            return
        try:
            self._complete()
        except BaseException:
            self._remove()
            raise
        self._remove.detach()

    def _complete(self) -> None:
        if not self._images:
            raise Error(str(self._folder), "it has no image", "at least one image", "call add_image")
        categories = [{"id": index, "name": name, "supercategory": ""}
                      for index, name in enumerate(self._scene.class_names) if index > 0]  # fmt: skip
        text = json.dumps({"info": {"description": "glidar"}, "licenses": [], "images": self._images,
                           "annotations": self._annotations, "categories": categories})  # fmt: skip
        (self._root / "annotations.json").write_text(text + "\n", encoding="utf-8")
        if self._folder.exists():
            raise Error(str(self._folder), "it was made meanwhile", "a new folder", "choose another name")
        self._root.rename(self._folder)


def _remove_folders(made: list[Path]) -> None:
    """Removes a folder, and those above it that were made for it, unless others use them."""
    shutil.rmtree(made[0], ignore_errors=True)
    with contextlib.suppress(OSError):
        for parent in made[1:]:
            parent.rmdir()


def _pinhole(sensor: Sensor) -> dict[str, Any]:
    """The same camera without noise."""
    described = sensor.ground_truth().to_dict()
    optics = described.get("optics", {})
    if not isinstance(optics, Mapping) or optics.get("type") != "pinhole" or "fx" not in optics:
        raise Error("sensor", shown(optics.get("type")), "a camera with a pinhole", "glidar.camera() returns one")
    return described


def _bands(described: dict[str, Any], rows: int, cols: int, factor: int) -> Iterator[Sensor]:
    """The same camera with more pixels, as cameras of some of its rows each, which limits memory."""
    optics = described["optics"]
    corner = 0.5 - optics.get("pixel_centre", 0.5)  # from the principal point's origin to the corner of the image
    finer = dict(optics)
    for key in ("width", *_INTRINSICS):
        finer[key] = optics[key] * factor
    for key in _CENTRES:
        finer[key] = (optics[key] + corner) * factor - corner
    step = max(1, _MAX_RAYS // (cols * factor**2))
    for first in range(0, rows, step):
        height = min(step, rows - first) * factor
        yield Sensor.from_dict({**described, "optics": {**finer, "height": height, "cy": finer["cy"] - first * factor}})


def _colours(fine: Frame, factor: int) -> npt.NDArray[np.uint8]:
    """Means of the surface colours, lit at the sensor; nothing is black."""
    cloud = fine.cloud(["colour", "incidence"])
    light = np.cos(cloud["incidence"].astype(np.float64))[..., None]
    colours = np.where(np.isnan(light), 0.0, cloud["colour"] * light)
    rows, cols = fine.rows // factor, fine.cols // factor
    means = colours.reshape(rows, factor, cols, factor, 3).mean((1, 3))
    pixels: npt.NDArray[np.uint8] = np.clip(np.round(255.0 * means), 0, 255).astype(np.uint8)
    return pixels


def _region(mask: npt.NDArray[np.bool_]) -> dict[str, Any]:
    """Area, box x, y, width, height and run lengths of a mask, column by column, of zeros first."""
    rows, cols = np.flatnonzero(mask.any(1)), np.flatnonzero(mask.any(0))
    line = np.concatenate([[False], mask.ravel(order="F"), [False]])
    changes = np.flatnonzero(line[1:] != line[:-1])
    counts = np.diff(np.concatenate([[0], changes, [mask.size]]))
    counts = counts[:-1] if counts[-1] == 0 else counts
    left, top = int(cols[0]), int(rows[0])
    return {
        "area": int(mask.sum()),
        "bbox": [left, top, int(cols[-1]) + 1 - left, int(rows[-1]) + 1 - top],
        "segmentation": {"size": list(mask.shape), "counts": counts.tolist()},
    }


def _png(pixels: npt.NDArray[np.uint8]) -> bytes:
    """An 8-bit RGB image (ISO/IEC 15948)."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows, cols, _ = pixels.shape
    lines = np.zeros((rows, 1 + 3 * cols), np.uint8)  # a filter of type 0 before each line
    lines[:, 1:] = pixels.reshape(rows, -1)
    header = struct.pack(">IIBBBBB", cols, rows, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(lines.tobytes())) + chunk(b"IEND", b"")
