# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Functions that measure a scene with one call."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error
from ._frame import Frame
from ._poses import inverse
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
    start_ns: int | None = None,
    renderer: str = "auto",
    threads: int = 0,
) -> Frame:
    """Measures a scene once.

    The scene keeps the renderer and the beams, so that a second call with the same sensor costs only the
    measurement.

    Args:
        scene: the scene to measure.
        sensor: a Sensor, the name of a preset or a sensor file; None: the sensor of the scene file.
        pose: the sensor's pose: world_from_sensor (4, 4), m, or a Trajectory; None: that of the scene file,
            else a pose from which the whole scene is visible.
        seed: seed of all random numbers, 0 to 2**64 - 1.
        frame: number of the frame. It starts at start_ns + frame / rate_hz and selects the random numbers.
        objects: poses of all objects of the scene (k, 4, 4), or a list of k poses and trajectories;
            None: as the scene specifies.
        columns: columns that clouds of the frame can have: names, "all", or None for xyz, intensity, range,
            normal, instance, class. Ground truth that no column needs is not computed.
        sensor_id: number of the sensor in its rig; it selects the random numbers.
        start_ns: start of the run, ns: the stamp of frame 0. None: the first time of the pose's trajectory, of
            objects' trajectories with times since 1970, or else 0. Trajectories are sampled as on the command
            line (docs/files/motion.md).
        renderer, threads: as for ``Simulator``.

    Raises:
        Error: a wrong shape, a number that is not finite, or an unknown column.
    """
    simulator = _checked(scene).simulator(sensor, renderer=renderer, threads=threads)
    return simulator.simulate(
        pose, seed=seed, frame=frame, objects=objects, columns=columns, sensor_id=sensor_id, start_ns=start_ns
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
    start_ns: int | None = None,
    renderer: str = "auto",
    threads: int = 0,
) -> list[Frame]:
    """Measures a scene at many poses in one call, without Python's lock. Frame k is bit-identical to the result of
    ``simulate`` for poses[k], seeds[k], frames[k].

    Args:
        poses: world_from_sensor, (N, 4, 4), m, or a list of N poses and trajectories.
        seeds: N seeds, or one for all; None: 1 + k for frame k, so that noise differs between frames.
        frames: N frame numbers, or one for all.
        objects: poses of the scene's k objects: (N, k, 4, 4), or (k, 4, 4) or a list of k poses and
            trajectories for all frames; None: as the scene specifies.

    The other arguments and the errors are those of ``simulate``.
    """
    simulator = _checked(scene).simulator(sensor, renderer=renderer, threads=threads)
    return simulator.simulate_batch(
        poses, seeds, frames=frames, objects=objects, columns=columns, sensor_id=sensor_id, start_ns=start_ns
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
    start_ns: int | None = None,
    renderer: str = "auto",
    threads: int = 0,
    batch: int = 8,
) -> Iterator[Frame]:
    """Measures a scene at many poses and yields one frame after the other, bit-identical to those of
    ``simulate_batch``. Neither poses nor frames are stored: memory does not grow with the number of poses. The
    loop may end at any frame.

    Args:
        poses: world_from_sensor: an array (N, 4, 4), m, any iterable of poses and trajectories, or one pose.
        seeds: an iterable with one for each pose, or one for all; None: 1 + k for frame k.
        frames: an iterable with one frame number for each pose, or one for all.
        objects: poses of the scene's k objects for all frames: (k, 4, 4), or a list of k poses and
            trajectories. Or for each frame: (N, k, 4, 4), as an array or nested lists, or an iterator with
            the poses of one frame at a time. None: as the scene specifies.
        batch: number of poses that are read and measured before the first of their frames is yielded, at
            least 1; use 1 when a pose depends on the previous frame.

    Raises:
        Error: names the frame by its index, such as poses[7], after the frames before it are yielded.

    The other arguments and the errors are those of ``simulate``.
    """
    simulator = _checked(scene).simulator(sensor, renderer=renderer, threads=threads)
    return simulator.simulate_iter(
        poses,
        seeds,
        frames=frames,
        objects=objects,
        columns=columns,
        sensor_id=sensor_id,
        start_ns=start_ns,
        batch=batch,
    )


def simulate_rig(
    scene: Scene,
    pose: PoseLike | None = None,
    *,
    seed: int = 1,
    frame: int = 0,
    objects: PoseLike | Sequence[PoseLike] | None = None,
    columns: str | Iterable[str] | None = None,
    start_ns: int | None = None,
    renderer: str = "auto",
    threads: int = 0,
) -> dict[str, Frame]:
    """Measures a scene once with each sensor of its scene file's rig; returns frames by sensor name.

    Args:
        pose: the rig's pose: world_from_rig (4, 4), m, or a Trajectory; None: that of the scene file, else
            a pose from which the first sensor sees the whole scene.

    The other arguments and the errors are those of ``simulate``.
    """
    if not _checked(scene).rig:
        raise Error("scene", "the scene has no sensors", "a scene file with sensors")
    simulators = [(m, scene.simulator(m.sensor, renderer=renderer, threads=threads)) for m in scene.rig.values()]
    rig = scene._core.rig_motion() if pose is None else trajectories(pose, "pose")
    if rig is None:
        first, simulator = simulators[0]
        rig = _core.mounted(simulator._core.usual_motion(), inverse(first.rig_from_sensor)[None])
    return {
        sensor.name: simulator.simulate(
            Trajectory(_core.mounted(rig, sensor.rig_from_sensor[None])),
            seed=seed,
            frame=frame,
            objects=objects,
            columns=columns,
            sensor_id=sensor.number,
            start_ns=start_ns,
        )
        for sensor, simulator in simulators
    }
