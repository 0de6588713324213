# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Poses, seeds and frame numbers of a sequence of frames, read in batches from arrays or iterators."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any, Callable

import numpy as np

from . import _core
from ._errors import Error
from ._inputs import MAX_UINT32, MAX_UINT64, whole
from ._trajectory import Trajectory, is_per_frame, object_trajectories, trajectories

DEFAULT_SEED = 1  # as on the command line


@dataclass(frozen=True)
class FrameBatch:
    """The inputs of consecutive frames."""

    first: int
    """Index of the first frame."""
    sensors: list[_core.Trajectories]
    """The sensor's trajectory in each frame."""
    objects: list[_core.Trajectories] | None
    """The trajectories of all objects in each frame; None: as the scene specifies."""
    seeds: list[int]
    numbers: list[int]

    def sliced(self, k: int) -> FrameBatch:
        """Frame k of the batch as a batch of its own."""
        objects = None if self.objects is None else self.objects[k : k + 1]
        part = slice(k, k + 1)
        return FrameBatch(self.first + k, self.sensors[part], objects, self.seeds[part], self.numbers[part])


class FrameInputs:
    """Iterators over poses, seeds, frame numbers and objects' poses, which advance together."""

    def __init__(self, poses: Any, seeds: Any, numbers: Any, objects: Any, count: int) -> None:
        if _is_single(poses):
            poses = [poses]
        if not isinstance(poses, Iterable):
            raise Error("poses", f"a {type(poses).__name__}", "an array N x 4 x 4, a list or a generator of poses")
        for name, values in (("seeds", seeds), ("frames", numbers)):
            _require_one_for_each(name, values, poses, "one for each pose, or one for all")
        self._poses = enumerate(iter(poses))
        self._seed_of = _per_frame(seeds, "seeds", MAX_UINT64)
        self._number_of = _per_frame(numbers, "frames", MAX_UINT32)
        self._objects_of = _objects_per_frame(objects, count, poses)

    def take(self, count: int) -> tuple[FrameBatch, Exception | None]:
        """The next frames, at most `count`; fewer at the end. An error ends the batch and is returned with it."""
        batch: FrameBatch | None = None
        for index, pose in self._next_poses(count):
            if isinstance(pose, Exception):
                return batch or FrameBatch(index, [], None, [], []), pose
            try:
                one = self._batch_of(index, pose)
            except Exception as error:  # raised after the frames before it are measured
                return batch or FrameBatch(index, [], None, [], []), error
            batch = one if batch is None else _joined(batch, one)
        return batch or FrameBatch(0, [], None, [], []), None

    def _next_poses(self, count: int) -> Iterator[tuple[int, Any]]:
        """The next poses; an exception of the caller's generator instead of its pose."""
        try:
            yield from islice(self._poses, count)
        except Exception as error:
            yield -1, error

    def _batch_of(self, index: int, pose: Any) -> FrameBatch:
        sensor = trajectories(pose, f"poses[{index}]")
        if len(sensor) != 1:
            raise Error(f"poses[{index}]", f"{len(sensor)} poses", "one pose, 4x4, or a Trajectory")
        objects = self._objects_of(index)
        seed, number = self._seed_of(index), self._number_of(index)
        return FrameBatch(index, [sensor], None if objects is None else [objects], [seed], [number])


def _joined(one: FrameBatch, other: FrameBatch) -> FrameBatch:
    objects = None if one.objects is None or other.objects is None else one.objects + other.objects
    return FrameBatch(
        one.first, one.sensors + other.sensors, objects, one.seeds + other.seeds, one.numbers + other.numbers
    )


def _is_single(poses: Any) -> bool:
    """Whether it is one pose, which simulate_batch accepts too."""
    if isinstance(poses, (list, tuple)) and len(poses) == 4:
        rows = [row for row in poses if isinstance(row, (list, tuple, np.ndarray)) and len(row) == 4]
        return len(rows) == 4 and not any(hasattr(number, "__len__") for row in rows for number in row)
    return isinstance(poses, Trajectory) or getattr(poses, "ndim", None) == 2


def _require_one_for_each(name: str, values: Any, poses: Any, allowed: str) -> None:
    is_several = hasattr(values, "__len__") and getattr(values, "ndim", 1) > 0
    if is_several and hasattr(poses, "__len__") and len(values) != len(poses):
        raise Error(name, f"{len(values)} for {len(poses)} poses", allowed)


def _next_of(values: Iterator[Any], name: str, index: int) -> Any:
    for value in values:
        return value
    raise Error(f"{name}[{index}]", "there is none", "one for each pose, or one for all")


def _per_frame(values: Any, name: str, maximum: int) -> Callable[[int], int]:
    """A function from a frame's index to its number: one for all, or the next of an iterator; None: default seeds."""
    if values is None:
        return lambda index: DEFAULT_SEED + index
    if not isinstance(values, Iterable) or isinstance(values, np.ndarray) and values.ndim == 0:
        same = whole(values, name, maximum)
        return lambda index: same
    several = iter(values)
    return lambda index: whole(_next_of(several, name, index), f"{name}[{index}]", maximum)


def _objects_per_frame(objects: Any, count: int, poses: Any) -> Callable[[int], _core.Trajectories | None]:
    """A function from a frame's index to the trajectories of all objects: None, one for all, or the next of an iterator."""
    if not isinstance(objects, Iterator):
        if objects is None or not is_per_frame(objects, "objects"):
            same = object_trajectories(objects, 1, count)
            return lambda index: same
        _require_one_for_each("objects", objects, poses, "poses for each frame, or the same for all")
    several = iter(objects)

    def of(index: int) -> _core.Trajectories | None:
        return object_trajectories(_next_of(several, "objects", index), 1, count, f"objects[{index}]")

    return of
