# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Options of the files that frames are saved to."""

from __future__ import annotations

from collections.abc import Iterable

from . import _core
from ._errors import Error
from ._inputs import column_list, floats, one_of

_PCD = ("ascii", "binary", "binary_compressed")


def file_options(pcd: str, ply_ascii: bool, depth_units_per_m: float) -> _core.SaveOptions:
    """Options with the encodings of PCD, PLY and depth images."""
    scale = float(floats(depth_units_per_m, "depth_units_per_m", ()))
    if scale <= 0.0:
        raise Error("depth_units_per_m", f"{scale}", "a finite number above 0")
    options = _core.SaveOptions()
    options.set_pcd(_PCD.index(one_of(pcd, "pcd", _PCD)))
    options.set_ply_ascii(ply_ascii)
    options.set_depth_units_per_m(scale)
    return options


def require_one(columns: str | Iterable[str] | None, layout: str | None) -> None:
    """Raises Error for a layout, which has its own columns, beside columns."""
    if layout is not None and columns is not None:
        remedy = "a layout has its own columns: leave columns out"
        raise Error("layout and columns", "both are given", "one of the two", remedy)


def set_columns(options: _core.SaveOptions, columns: str | Iterable[str] | None, layout: str | None) -> None:
    """Sets the columns of a cloud, or the layout that has its own."""
    require_one(columns, layout)
    options.columns = column_list(columns)
    options.set_layout(layout or "")
