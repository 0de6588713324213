# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""ROS bags of frames."""

from __future__ import annotations

import os
from collections.abc import Iterable

from . import _core
from ._bag_writer import bag_writer
from ._errors import Error, shown
from ._frame import Frame
from ._inputs import path_of


def save_bag(
    path: str | os.PathLike[str],
    frames: Iterable[Frame],
    *,
    columns: str | Iterable[str] | None = None,
    layout: str | None = None,
    deskew: bool = False,
) -> None:
    """Writes frames of one sensor to a ROS bag, like ``glidar render -o PATH``: NAME.mcap, NAME.rosbag2 (a folder for
    ROS 2) or NAME.bag (ROS 1).

    The bag has the poses of the frames in /tf and /ground_truth/odom and their times in /clock. With an iterator, such as
    ``simulate_iter``, only one frame is in memory.

    Args:
        frames: in the order of time.
        columns, layout, deskew: as for ``Frame.save``. Without columns and layout: those that suit the sensor.

    Raises:
        Error: an unknown suffix or layout, no frame, a frame of another sensor, or a column that was not kept. An
            existing bag stays unchanged.
    """
    target = path_of(path, "path")
    if not _core.is_bag_name(target):
        raise Error("path", f"the suffix of {shown(target)} is not that of a bag", ".mcap, .rosbag2 or .bag")
    bag = bag_writer(target, columns, layout, deskew)
    for frame in frames:
        if not isinstance(frame, Frame):
            raise Error("frames", f"a {type(frame).__name__}", "frames of glidar")
        frame.write_to(bag)
    bag.finish()
