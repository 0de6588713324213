# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What a long run of frames is measured with, taken piece by piece from whatever users hand in."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any, Callable

import numpy as np

from . import _core
from ._errors import Error
from ._inputs import MOST_32, MOST_64, dimensions, whole
from ._trajectory import object_trajectories, trajectories

DEFAULT_SEED = 1  # as on the command line


@dataclass(frozen=True)
class Piece:
    """Some frames one after the other."""

    first: int
    """Index of the first of them."""
    sensors: list[_core.Trajectories]
    """One trajectory of the sensor for each frame."""
    objects: list[_core.Trajectories] | None
    """Those of all objects for each frame."""
    seeds: list[int]
    numbers: list[int]

    def sliced(self, k: int) -> Piece:
        """Frame k of the piece alone."""
        objects = None if self.objects is None else self.objects[k : k + 1]
        part = slice(k, k + 1)
        return Piece(self.first + k, self.sensors[part], objects, self.seeds[part], self.numbers[part])


class Inputs:
    """Iterators over poses, seeds, frame numbers and poses of objects, which advance together."""

    def __init__(self, poses: Any, seeds: Any, numbers: Any, objects: Any, count: int) -> None:
        if not isinstance(poses, Iterable):
            raise Error("poses", f"a {type(poses).__name__}", "an array N x 4 x 4, a list or a generator of poses")
        for name, values in (("seeds", seeds), ("frames", numbers)):
            _require_one_for_each(name, values, poses)
        self._poses = enumerate(iter(poses))
        self._seed_of = _per_frame(seeds, "seeds", MOST_64)
        self._number_of = _per_frame(numbers, "frames", MOST_32)
        self._objects_of = _objects_per_frame(objects, count)

    def take(self, count: int) -> tuple[Piece, Exception | None]:
        """The next frames, up to `count`; fewer at the end, and before a fault, which comes with them."""
        piece: Piece | None = None
        for index, pose in self._taken(count):
            if isinstance(pose, Exception):
                return piece or Piece(index, [], None, [], []), pose
            try:
                one = self._piece_of(index, pose)
            except Exception as fault:  # raised once the frames before it are measured
                return piece or Piece(index, [], None, [], []), fault
            piece = one if piece is None else _joined(piece, one)
        return piece or Piece(0, [], None, [], []), None

    def _taken(self, count: int) -> Iterator[tuple[int, Any]]:
        """The next poses; an exception of the caller's generator in the place of its pose."""
        try:
            yield from islice(self._poses, count)
        except Exception as fault:
            yield -1, fault

    def _piece_of(self, index: int, pose: Any) -> Piece:
        sensor = trajectories(pose, f"poses[{index}]")
        if len(sensor) != 1:
            raise Error(f"poses[{index}]", f"{len(sensor)} poses", "one pose, 4x4, or a Trajectory")
        objects = self._objects_of(index)
        seed, number = self._seed_of(index), self._number_of(index)
        return Piece(index, [sensor], None if objects is None else [objects], [seed], [number])


def _joined(one: Piece, other: Piece) -> Piece:
    objects = None if one.objects is None or other.objects is None else one.objects + other.objects
    return Piece(
        one.first, one.sensors + other.sensors, objects, one.seeds + other.seeds, one.numbers + other.numbers
    )


def _require_one_for_each(name: str, values: Any, poses: Any) -> None:
    if hasattr(values, "__len__") and hasattr(poses, "__len__") and dimensions(values, name) > 0 and len(values) != len(poses):
        raise Error(name, f"{len(values)} for {len(poses)} poses", "one for each pose, or one for all")


def _next_of(values: Iterator[Any], name: str, index: int) -> Any:
    for value in values:
        return value
    raise Error(f"{name}[{index}]", "there is none", "one for each pose, or one for all")


def _per_frame(values: Any, name: str, most: int) -> Callable[[int], int]:
    """The number of each frame: one for all, the next of many, or for seeds also None."""
    if values is None:
        return lambda index: DEFAULT_SEED + index
    if not isinstance(values, Iterable) or isinstance(values, np.ndarray) and values.ndim == 0:
        same = whole(values, name, most)
        return lambda index: same
    several = iter(values)
    return lambda index: whole(_next_of(several, name, index), f"{name}[{index}]", most)


def _objects_per_frame(objects: Any, count: int) -> Callable[[int], _core.Trajectories | None]:
    """Trajectories of all objects in each frame: None, the same for all frames, or the next of many."""
    is_iterator = isinstance(objects, Iterator)
    if not is_iterator and not (isinstance(objects, np.ndarray) and objects.ndim == 4):
        same = object_trajectories(objects, 1, count)
        return lambda index: same
    several = iter(objects)

    def of(index: int) -> _core.Trajectories | None:
        return object_trajectories(_next_of(several, "objects", index), 1, count, f"objects[{index}]")

    return of
