# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Measuring scenes with sensors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error, shown
from ._inputs import MOST_32, MOST_64, column_list, one_of, whole, whole_numbers
from ._frame import Frame
from ._lazily import DEFAULT_SEED, Inputs, Piece
from ._origin import Origin, SceneSource
from ._scene_data import SceneData, not_a_scene
from ._sensor import Sensor
from ._state import Immutable, refuse_pickle
from ._trajectory import PoseLike, object_trajectories, trajectories

_RENDERERS = ("auto", "rays", "raster", "opengl")


class Simulator(Immutable):
    """A scene and a sensor made ready, so that measuring costs nothing but the measurement.

    It is its own copy, and it cannot be pickled: pickle scene and sensor, and make a simulator of them
    where they arrive.

    It keeps the scene as it is now: later changes of the scene are not seen. May be used from any
    thread; measurements of one scene take turns, each on all threads, without Python's lock.

    Args:
        scene: the ``Scene`` to measure.
        sensor: what measures; None: that of the scene file.
        renderer: "auto": "raster" for cameras and scanners where that is quicker, else "rays";
            both on the processor. "opengl" draws on a graphics device (cameras without distortion).
        threads: of the renderer; 0: one per processor.
    """

    def __init__(
        self, scene: SceneData, sensor: Sensor | None = None, *, renderer: str = "auto", threads: int = 0
    ) -> None:
        if not isinstance(scene, SceneData):
            raise not_a_scene(scene)
        chosen = scene.sensor if sensor is None else sensor
        if chosen is not None and not isinstance(chosen, Sensor):
            raise Error("sensor", shown(chosen), "a Sensor", "glidar.load_sensor() reads one")
        if chosen is None:
            raise Error("sensor", "the scene has none", "a sensor", "glidar.camera() makes one")
        one_of(renderer, "renderer", _RENDERERS)
        self.sensor = chosen
        self._origin = Origin(SceneSource(scene._recipe.copy()), chosen, renderer, threads)
        self._usual_fields = _core.fields_needed_by(column_list(None))
        self._core = _core.make_simulator(scene._core, chosen._core, renderer, whole(threads, "threads", 4096))

    __reduce_ex__ = refuse_pickle(
        "Simulator",
        "it holds a renderer and cannot be pickled",
        "pickle its scene and its sensor, and make another where they arrive: glidar.Simulator(scene, sensor)",
    )

    def simulate(
        self,
        pose: PoseLike | None = None,
        *,
        seed: int = 1,
        frame: int = 0,
        objects: PoseLike | Sequence[PoseLike] | None = None,
        columns: str | Iterable[str] | None = None,
        sensor_id: int = 0,
    ) -> Frame:
        """Measures once; see ``glidar.simulate``."""
        sensor = self._sensors(pose)
        if len(sensor) != 1:
            raise Error("pose", f"{len(sensor)} poses", "one pose, 4x4", "simulate_batch takes many")
        return Frame(
            self._core.simulate_one(
                sensor,
                object_trajectories(objects, 1, self._core.objects),
                (whole(seed, "seed", MOST_64), whole(frame, "frame", MOST_32), whole(sensor_id, "sensor_id", MOST_32)),
                self._fields(columns),
            ),
            self._origin,
        )

    def simulate_batch(
        self,
        poses: PoseLike | Sequence[PoseLike],
        seeds: int | npt.ArrayLike | None = None,
        *,
        frames: int | npt.ArrayLike = 0,
        objects: PoseLike | Sequence[PoseLike] | None = None,
        columns: str | Iterable[str] | None = None,
        sensor_id: int = 0,
    ) -> list[Frame]:
        """Measures many times in one call; see ``glidar.simulate_batch``."""
        return self._measure(self._sensors(poses), objects, seeds, frames, columns, sensor_id)

    def simulate_iter(
        self,
        poses: Iterable[PoseLike],
        seeds: int | Iterable[int] | None = None,
        *,
        frames: int | Iterable[int] = 0,
        objects: PoseLike | Sequence[PoseLike] | Iterator[Sequence[PoseLike]] | None = None,
        columns: str | Iterable[str] | None = None,
        sensor_id: int = 0,
        batch: int = 8,
    ) -> Iterator[Frame]:
        """Measures one frame after the other; see ``glidar.simulate_iter``."""
        inputs = Inputs(poses, seeds, frames, objects, self._core.objects)
        together = whole(batch, "batch", MOST_32)
        if together == 0:
            raise Error("batch", "0", "a whole number from 1")
        return self._iterate(inputs, self._fields(columns), whole(sensor_id, "sensor_id", MOST_32), together)

    def _iterate(self, inputs: Inputs, fields: _core.HitFieldMask, sensor_id: int, batch: int) -> Iterator[Frame]:
        while True:
            piece, fault = inputs.take(batch)
            yield from self._frames_of(piece, fields, sensor_id)
            if fault is not None:
                raise fault
            if len(piece.sensors) < batch:
                return

    def _frames_of(self, piece: Piece, fields: _core.HitFieldMask, sensor_id: int) -> Iterator[Frame]:
        """The frames of a piece; none is kept here once it was handed out."""
        if not piece.sensors:
            return
        try:
            measured = self._measured(piece, fields, sensor_id)
        except Error as error:
            if len(piece.sensors) == 1:
                raise Error(f"frame {piece.first}, {error.where}", error.found, error.allowed, error.remedy) from error
            for k in range(len(piece.sensors)):  # which of them is it?
                yield from self._frames_of(piece.sliced(k), fields, sensor_id)
            return
        measured.reverse()
        while measured:
            yield Frame(measured.pop(), self._origin)

    def _measured(self, piece: Piece, fields: _core.HitFieldMask, sensor_id: int) -> list[_core.Frame]:
        objects = None if piece.objects is None else _core.joined(piece.objects)
        keys = (np.array(piece.seeds, np.uint64), np.array(piece.numbers, np.uint32), sensor_id)
        return self._core.simulate(_core.joined(piece.sensors), objects, keys, fields)

    def _sensors(self, poses: PoseLike | Sequence[PoseLike] | None) -> _core.Trajectories:
        if poses is None:
            return self._core.usual_motion()
        return trajectories(poses, "pose")

    def _fields(self, columns: str | Iterable[str] | None) -> _core.HitFieldMask:
        return self._usual_fields if columns is None else _core.fields_needed_by(column_list(columns))

    def _measure(
        self,
        sensors: _core.Trajectories,
        objects: PoseLike | Sequence[PoseLike] | None,
        seeds: int | npt.ArrayLike | None,
        numbers: int | npt.ArrayLike,
        columns: str | Iterable[str] | None,
        sensor_id: int,
    ) -> list[Frame]:
        count = len(sensors)
        measured = self._core.simulate(
            sensors,
            object_trajectories(objects, count, self._core.objects),
            (
                whole_numbers(DEFAULT_SEED + np.arange(count) if seeds is None else seeds, "seed", count, 64),
                whole_numbers(numbers, "frame", count, 32),
                whole(sensor_id, "sensor_id", MOST_32),
            ),
            self._fields(columns),
        )
        return [Frame(core, self._origin) for core in measured]
