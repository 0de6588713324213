# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The writer of ROS bags."""

from __future__ import annotations

from collections.abc import Iterable

from . import _core
from ._file_options import require_one
from ._inputs import column_list


def bag_writer(
    path: str, columns: str | Iterable[str] | None, layout: str | None, deskew: bool
) -> _core.BagWriter:
    """A bag with these points; without columns and layout, those that suit the sensor."""
    require_one(columns, layout)
    names = [] if columns is None or columns == "default" else column_list(columns)
    return _core.BagWriter(path, layout or "", names, deskew)
