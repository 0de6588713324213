# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Measuring a scene with one call."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error
from ._frame import Frame
from ._scene import Scene
from ._scene_data import not_a_scene
from ._sensor import Sensor
from ._trajectory import PoseLike, Trajectory, trajectories


def _checked(scene: object) -> Scene:
    if not isinstance(scene, Scene):
        raise not_a_scene(scene)
    return scene


def simulate(
    scene: Scene,
    sensor: Sensor | str | os.PathLike[str] | None = None,
    pose: PoseLike | None = None,
    *,
    seed: int = 1,
    frame: int = 0,
    objects: PoseLike | Sequence[PoseLike] | None = None,
    columns: str | Iterable[str] | None = None,
    sensor_id: int = 0,
    renderer: str = "auto",
    threads: int = 0,
) -> Frame:
    """Measures a scene once.

    What was made ready is kept in the scene: the next call with the same sensor costs the measurement
    alone.

    Args:
        scene: what is measured.
        sensor: a Sensor, the name of a preset or a sensor file; None: that of the scene file.
        pose: of the sensor: world_from_sensor (4x4), or a Trajectory; None: as the scene file says,
            else where the sensor sees all of the scene.
        seed: of all random numbers, 0 to 2**64 - 1.
        frame: number of the frame: it starts at frame / rate_hz, and frames draw different numbers.
        objects: poses of all objects of the scene (k, 4, 4), or a list of k poses and trajectories;
            None: as the scene says.
        columns: what clouds of the frame will hold: names, "all", or None for xyz, intensity, range,
            normal, instance, class. Truth that no column needs is not computed.
        sensor_id: sensors of one rig draw different random numbers.
        renderer, threads: as for ``Simulator``.

    Raises:
        Error: a wrong shape, a number that is not finite, an unknown column.
    """
    simulator = _checked(scene).simulator(sensor, renderer=renderer, threads=threads)
    return simulator.simulate(
        pose, seed=seed, frame=frame, objects=objects, columns=columns, sensor_id=sensor_id
    )


def simulate_batch(
    scene: Scene,
    sensor: Sensor | str | os.PathLike[str] | None,
    poses: PoseLike | Sequence[PoseLike],
    seeds: int | npt.ArrayLike | None = None,
    *,
    frames: int | npt.ArrayLike = 0,
    objects: PoseLike | Sequence[PoseLike] | None = None,
    columns: str | Iterable[str] | None = None,
    sensor_id: int = 0,
    renderer: str = "auto",
    threads: int = 0,
) -> list[Frame]:
    """Measures a scene at many poses in one call, without Python's lock; frame k is, to the bit, what
    ``simulate`` makes of poses[k], seeds[k], frames[k].

    Args:
        poses: world_from_sensor, (N, 4, 4), or a list of N poses and trajectories.
        seeds: N seeds, or one for all; None: 1 + k for frame k, so that every frame has noise of its own.
        frames: N frame numbers, or one for all.
        objects: poses of the scene's k objects: (N, k, 4, 4), or (k, 4, 4) or a list of k poses and
            trajectories for all frames; None: as the scene says.

    The other arguments and errors are those of ``simulate``.
    """
    simulator = _checked(scene).simulator(sensor, renderer=renderer, threads=threads)
    return simulator.simulate_batch(
        poses, seeds, frames=frames, objects=objects, columns=columns, sensor_id=sensor_id
    )


def simulate_iter(
    scene: Scene,
    sensor: Sensor | str | os.PathLike[str] | None,
    poses: Iterable[PoseLike],
    seeds: int | Iterable[int] | None = None,
    *,
    frames: int | Iterable[int] = 0,
    objects: PoseLike | Sequence[PoseLike] | Iterator[Sequence[PoseLike]] | None = None,
    columns: str | Iterable[str] | None = None,
    sensor_id: int = 0,
    renderer: str = "auto",
    threads: int = 0,
    batch: int = 8,
) -> Iterator[Frame]:
    """Measures a scene at many poses and hands out one frame after the other, the same to the bit as those
    of ``simulate_batch``. Neither poses nor frames are kept: a generator of millions of poses takes no more
    memory than one of ten. The loop may be left at any frame.

    Args:
        poses: world_from_sensor: an array (N, 4, 4), any iterable of poses and trajectories, or one alone.
        seeds: one for each pose from any iterable, or one for all; None: 1 + k for frame k.
        frames: frame numbers; one for each pose from any iterable, or one for all.
        objects: poses of the scene's k objects for all frames: (k, 4, 4), or a list of k poses and
            trajectories. Or for each frame: (N, k, 4, 4), as an array or nested lists, or an iterator over
            such for one frame. None: as the scene says.
        batch: so many poses are read and measured before the first of their frames is handed out, from
            1; 1 where a pose depends on the frame before it.

    Raises:
        Error: names the frame by its index, such as poses[7]; frames before it were handed out.

    The other arguments and errors are those of ``simulate``.
    """
    simulator = _checked(scene).simulator(sensor, renderer=renderer, threads=threads)
    return simulator.simulate_iter(
        poses, seeds, frames=frames, objects=objects, columns=columns, sensor_id=sensor_id, batch=batch
    )


def simulate_rig(
    scene: Scene,
    pose: PoseLike | None = None,
    *,
    seed: int = 1,
    frame: int = 0,
    objects: PoseLike | Sequence[PoseLike] | None = None,
    columns: str | Iterable[str] | None = None,
    renderer: str = "auto",
    threads: int = 0,
) -> dict[str, Frame]:
    """Measures a scene once with each sensor of its scene file's rig; gives frames by their names.

    Args:
        pose: of the rig: world_from_rig (4x4), or a Trajectory; None: as the scene file says, else
            where its first sensor sees all of the scene.

    The other arguments and errors are those of ``simulate``.
    """
    if not _checked(scene).rig:
        raise Error("scene", "it has no sensors", "a scene file with sensors")
    mounts = [(m, scene.simulator(m.sensor, renderer=renderer, threads=threads)) for m in scene.rig.values()]
    rig = scene._core.rig_motion() if pose is None else trajectories(pose, "pose")
    if rig is None:
        first, simulator = mounts[0]
        rig = _core.mounted(simulator._core.usual_motion(), np.asarray(np.linalg.inv(first.rig_from_sensor)[None], np.float64))
    return {
        mount.name: simulator.simulate(
            Trajectory(_core.mounted(rig, mount.rig_from_sensor[None])),
            seed=seed,
            frame=frame,
            objects=objects,
            columns=columns,
            sensor_id=mount.number,
        )
        for mount, simulator in mounts
    }
