# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Simulators: a scene, a sensor and a renderer, prepared for many measurements."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error, shown
from ._inputs import MAX_TIME_NS, MAX_UINT32, MAX_UINT64, column_list, one_of, whole, whole_numbers
from ._frame import Frame
from ._frame_inputs import DEFAULT_SEED, FrameInputs, FrameBatch
from ._origin import Origin, SceneSource
from ._scene_data import SceneData, not_a_scene
from ._sensor import Sensor
from ._state import Immutable, refuse_pickle
from ._trajectory import PoseLike, object_trajectories, trajectories

#: The number of the sensor, and the start of the run.
_RunKeys: TypeAlias = "tuple[int, int | None]"

_RENDERERS = ("auto", "rays", "raster", "gpu", "opengl")


def _run_keys(sensor_id: int, start_ns: int | None) -> _RunKeys:
    start = None if start_ns is None else whole(start_ns, "start_ns", MAX_TIME_NS)
    return whole(sensor_id, "sensor_id", MAX_UINT32), start


class Simulator(Immutable):
    """A scene and a sensor with a prepared renderer, so that each call costs only the measurement.

    It keeps the present state of the scene; later changes of the scene have no effect on it. It may be used from
    any thread: measurements of one scene run one at a time, each on all threads, without Python's lock.

    A simulator is immutable, so a copy is the same object. It cannot be pickled: pickle its scene and sensor, and
    create a simulator from them in the other process.

    Args:
        scene: the ``Scene`` to measure.
        sensor: the sensor; None: that of the scene file.
        renderer: "auto": "raster" for pinhole cameras where it is faster, else "rays"; both run on the
            processor. "gpu" casts on a graphics device, with the same results; "opengl" is another name of it.
        threads: number of threads of the renderer; 0: one per processor.

    Raises:
        Error: an argument of another type, a scene without a sensor, or a renderer that cannot be created.
    """

    def __init__(
        self, scene: SceneData, sensor: Sensor | None = None, *, renderer: str = "auto", threads: int = 0
    ) -> None:
        if not isinstance(scene, SceneData):
            raise not_a_scene(scene)
        chosen = scene.sensor if sensor is None else sensor
        if chosen is not None and not isinstance(chosen, Sensor):
            raise Error("sensor", shown(chosen), "a Sensor", "glidar.load_sensor() returns one")
        if chosen is None:
            raise Error("sensor", "the scene has no sensor", "a sensor", "glidar.camera() returns one")
        one_of(renderer, "renderer", _RENDERERS)
        self.sensor = chosen
        self._origin = Origin(SceneSource(scene._recipe.copy()), chosen, renderer, threads)
        self._default_hit_columns = _core.hit_columns_for(column_list(None))
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
        start_ns: int | None = None,
    ) -> Frame:
        """Measures once; see ``glidar.simulate``."""
        sensor = self._sensors(pose)
        if len(sensor) != 1:
            raise Error("pose", f"{len(sensor)} poses", "one pose, 4x4", "simulate_batch measures many")
        return Frame(
            self._core.simulate_one(
                sensor,
                object_trajectories(objects, 1, self._core.objects),
                (whole(seed, "seed", MAX_UINT64), whole(frame, "frame", MAX_UINT32), *_run_keys(sensor_id, start_ns)),
                self._hit_columns(columns),
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
        start_ns: int | None = None,
    ) -> list[Frame]:
        """Measures at many poses in one call; see ``glidar.simulate_batch``."""
        return self._measure(
            self._sensors(poses), objects, (seeds, frames), columns, _run_keys(sensor_id, start_ns)
        )

    def simulate_iter(
        self,
        poses: Iterable[PoseLike],
        seeds: int | Iterable[int] | None = None,
        *,
        frames: int | Iterable[int] = 0,
        objects: PoseLike | Sequence[PoseLike] | Iterator[Sequence[PoseLike]] | None = None,
        columns: str | Iterable[str] | None = None,
        sensor_id: int = 0,
        start_ns: int | None = None,
        batch: int = 8,
    ) -> Iterator[Frame]:
        """Measures and yields one frame after the other; see ``glidar.simulate_iter``."""
        inputs = FrameInputs(poses, seeds, frames, objects, self._core.objects)
        together = whole(batch, "batch", MAX_UINT32)
        if together == 0:
            raise Error("batch", "0", "a whole number from 1")
        return self._iterate(inputs, self._hit_columns(columns), _run_keys(sensor_id, start_ns), together)

    def _iterate(self, inputs: FrameInputs, hit_columns: _core.HitColumnMask, run: _RunKeys, batch: int) -> Iterator[Frame]:
        while True:
            batch_inputs, error = inputs.take(batch)
            yield from self._frames_of(batch_inputs, hit_columns, run)
            if error is not None:
                raise error
            if len(batch_inputs.sensors) < batch:
                return

    def _frames_of(self, batch_inputs: FrameBatch, hit_columns: _core.HitColumnMask, run: _RunKeys) -> Iterator[Frame]:
        """The frames of a batch. Each is released here when it is yielded."""
        if not batch_inputs.sensors:
            return
        try:
            measured = self._measured(batch_inputs, hit_columns, run)
        except Error as error:
            if len(batch_inputs.sensors) == 1:
                raise Error(f"frame {batch_inputs.first}, {error.where}", error.found, error.allowed, error.remedy) from error
            for k in range(len(batch_inputs.sensors)):  # find the frame that fails
                yield from self._frames_of(batch_inputs.sliced(k), hit_columns, run)
            return
        measured.reverse()
        while measured:
            yield Frame(measured.pop(), self._origin)

    def _measured(self, batch_inputs: FrameBatch, hit_columns: _core.HitColumnMask, run: _RunKeys) -> list[_core.Frame]:
        objects = None if batch_inputs.objects is None else _core.joined(batch_inputs.objects)
        keys = (np.array(batch_inputs.seeds, np.uint64), np.array(batch_inputs.numbers, np.uint32), *run)
        return self._core.simulate(_core.joined(batch_inputs.sensors), objects, keys, hit_columns)

    def _sensors(self, poses: PoseLike | Sequence[PoseLike] | None) -> _core.Trajectories:
        if poses is None:
            return self._core.usual_motion()
        return trajectories(poses, "pose")

    def _hit_columns(self, columns: str | Iterable[str] | None) -> _core.HitColumnMask:
        return self._default_hit_columns if columns is None else _core.hit_columns_for(column_list(columns))

    def _measure(
        self,
        sensors: _core.Trajectories,
        objects: PoseLike | Sequence[PoseLike] | None,
        frames: tuple[int | npt.ArrayLike | None, int | npt.ArrayLike],
        columns: str | Iterable[str] | None,
        run: _RunKeys,
    ) -> list[Frame]:
        count = len(sensors)
        seeds, numbers = frames
        measured = self._core.simulate(
            sensors,
            object_trajectories(objects, count, self._core.objects),
            (
                whole_numbers(DEFAULT_SEED + np.arange(count) if seeds is None else seeds, "seed", count, 64),
                whole_numbers(numbers, "frame", count, 32),
                *run,
            ),
            self._hit_columns(columns),
        )
        return [Frame(core, self._origin) for core in measured]
