# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Outputs of frames: files, recordings and networks."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from types import TracebackType

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error
from ._file_options import file_options, set_cloud, set_columns
from ._frame import Frame
from ._imu import STANDARD_GRAVITY, RigImu
from ._inputs import MAX_UINT64, floats, log, path_of, text_of, times_ns, whole
from ._pictures import set_picture
from ._scene_data import RigSensor
from ._sensor import Sensor, load_sensor
from ._trajectory import Trajectory


def output_formats() -> dict[str, str]:
    """The suffixes of files that ``open_output`` writes, and what they are, as ``glidar render --help`` lists them."""
    return dict(_core.output_formats())


class Output:
    """An open output, see ``open_output``. As a context manager, it is closed at the end, or discarded after an
    exception."""

    def __init__(self, core: _core.Output) -> None:
        self._core = core

    def write(self, frame: Frame) -> None:
        """Adds a frame. Its pose and stamp are written where the format has them.

        Args:
            frame: after the last one in time. The first one determines the scene.

        Raises:
            Error: a frame of another sensor, or of a scene with other objects, an output that has ended, an option that does not fit the sensor, a column that was not kept, an
                input file of the scene or sensor as the output, or a full disk.
        """
        if not isinstance(frame, Frame):
            raise Error("frame", f"a {type(frame).__name__}", "a frame of glidar")
        frame.write_to(self._core)

    def close(self) -> list[str]:
        """Completes the files, which appear under their names, and returns them as text, a line for each output. The
        output has then ended; closing it again does nothing.

        Raises:
            Error: there is no frame, or the system refuses.
        """
        return self._core.finish(log).splitlines()

    def discard(self) -> None:
        """Ends it without completing it: nothing of a recording remains."""
        self._core.discard()

    def __enter__(self) -> Output:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self.close()
        else:
            self.discard()


def open_output(
    path_or_url: str | os.PathLike[str],
    sensor: Sensor | str | os.PathLike[str] | Mapping[str, RigSensor] | None = None,
    *,
    trajectory: Trajectory | None = None,
    imus: Mapping[str, RigImu] | None = None,
    start_ns: int = 0,
    seed: int = 1,
    gravity_m_s2: npt.ArrayLike = STANDARD_GRAVITY,
    columns: str | Iterable[str] | None = None,
    layout: str | None = None,
    frame: str | None = None,
    drop_invalid: bool = False,
    deskew: bool = False,
    pcd: str = "binary",
    ply_ascii: bool = False,
    depth_units_per_m: float = 1000.0,
    crs: str | os.PathLike[str] = "",
    sidecar: bool = True,
    per_frame: bool = False,
    colour_by: str = "height",
    picture_size: tuple[int, int] = (1400, 1000),
    view_eye: npt.ArrayLike | None = None,
    view_target: npt.ArrayLike | None = None,
    driver: str = "",
    ouster_profile: str = "",
    livox_data_type: int = 0,
) -> Output:
    """Opens an output of frames, with the bytes of ``glidar render -o PATH`` of the same frames and options.

    The suffix selects the format; ``output_formats()`` lists them. Bags, packet captures, OSI traces and KITTI folders
    take all frames, and so do .pcd, .ply, .csv and .las, whose points have the columns ``stamp`` and ``frame`` and by
    default the world's axes; formats of one frame get a file for each, NAME_000007.npz for NAME.npz. ``udp://ADDRESS[:PORT]``
    sends the packets of a sensor, ``ros2://[NAMESPACE]`` publishes topics of ROS 2, both as fast as frames are written.

    Args:
        path_or_url: file, folder or network.
        sensor: the sensor of all frames (a Sensor, the name of a preset or a sensor file), or the sensors of a rig
            by name, as ``scene.rig``, whose frames have the numbers of their sensors; None: that of the first frame.
        trajectory: world_from_rig, the motion of the rig; objects then move as in the first frame. Bags then have
            poses at 100 Hz, packets of Velodyne and bags the samples of IMUs. None: poses are known at frames only.
        imus: IMUs of the rig by name, as of ``rig_imus``; they need the trajectory.
        start_ns: start of the run, ns: the time of the samples with number 0.
        seed: seed of the samples of IMUs, 0 to 2**64 - 1.
        gravity_m_s2: that IMUs measure, (3,), m/s^2, world frame.
        columns, layout, frame, drop_invalid, deskew, pcd, ply_ascii, depth_units_per_m, crs, sidecar, colour_by,
            picture_size, view_eye, view_target: as for ``Frame.save``. In a bag, without columns and layout: those
            that suit the sensor.
        per_frame: whether .pcd, .ply, .csv and .las get a file for each frame, in the sensor's axes, too.
        driver: the messages of a maker's driver in bags and ROS 2, such as "ouster" (docs/drivers.md).
        ouster_profile: packets of Ouster sensors: "LEGACY" or another profile; "": by the number of returns.
        livox_data_type: packets of Livox sensors: 1, 2 or 3; 0: as 1.

    Raises:
        Error: an unknown suffix, layout, column, driver or profile, or IMUs without a trajectory.
    """
    target = path_of(path_or_url, "path_or_url")
    options = file_options(pcd, ply_ascii, depth_units_per_m)
    set_columns(options, columns, layout)
    set_cloud(options, frame, drop_invalid, deskew, crs, sidecar, per_frame)
    set_picture(options, colour_by, picture_size, view_eye, view_target)
    options.set_driver(text_of(driver, "driver"))
    options.set_ouster_profile(text_of(ouster_profile, "ouster_profile"))
    options.set_livox_type(whole(livox_data_type, "livox_data_type", 3))
    core = _core.Output(target, options)
    if isinstance(sensor, Mapping):
        for mounted in sensor.values():
            core.add_sensor(mounted.name, mounted.number, mounted.sensor._core, _one_pose(mounted.rig_from_sensor))
    elif sensor is not None:
        only = sensor if isinstance(sensor, Sensor) else load_sensor(sensor)
        core.add_sensor("", 0, only._core, _one_pose(np.eye(4)))
    if imus and trajectory is None:
        raise Error("imus", "given without a trajectory", "a motion that is known at all times", "give the trajectory")
    for imu in (imus or {}).values():
        core.add_imu(imu.name, imu.imu._core, _one_pose(imu.rig_from_imu))
    start = int(times_ns([start_ns], "start_ns")[0])
    gravity = floats(gravity_m_s2, "gravity_m_s2", (3,))
    number = whole(seed, "seed", MAX_UINT64)
    if trajectory is not None:
        if not isinstance(trajectory, Trajectory):
            raise Error("trajectory", f"a {type(trajectory).__name__}", "a Trajectory")
        core.set_motion(trajectory._core, start, number, gravity)
    return Output(core)


def _one_pose(pose: npt.ArrayLike) -> npt.NDArray[np.float64]:
    return np.ascontiguousarray(pose, np.float64)[None]
