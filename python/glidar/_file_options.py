# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Options of outputs of frames."""

from __future__ import annotations

import os
from collections.abc import Iterable

from . import _core
from ._errors import Error
from ._inputs import column_list, floats, one_of

_PCD = ("ascii", "binary", "binary_compressed")


def file_options(pcd: str, ply_ascii: bool, depth_units_per_m: float) -> _core.OutputOptions:
    """Options with the encodings of PCD, PLY and depth images."""
    scale = float(floats(depth_units_per_m, "depth_units_per_m", ()))
    if scale <= 0.0:
        raise Error("depth_units_per_m", f"{scale}", "a finite number above 0")
    options = _core.OutputOptions()
    options.set_pcd(_PCD.index(one_of(pcd, "pcd", _PCD)))
    options.set_ply_ascii(ply_ascii)
    options.set_depth_units_per_m(scale)
    return options


def set_columns(options: _core.OutputOptions, columns: str | Iterable[str] | None, layout: str | None) -> None:
    """Sets the columns of a cloud, or the layout that has its own; neither: those that suit the output."""
    if layout is not None and columns is not None:
        remedy = "a layout has its own columns: leave columns out"
        raise Error("layout and columns", "both are given", "one of the two", remedy)
    options.columns = [] if columns is None or columns == "default" else column_list(columns)
    options.set_layout(layout or "")


def set_cloud(
    options: _core.OutputOptions,
    frame: str | None,
    drop_invalid: bool,
    deskew: bool,
    crs: str | os.PathLike[str],
    sidecar: bool,
    per_frame: bool = False,
) -> None:
    """Sets the axes, points and further files of a cloud."""
    options.frame = frame or ""
    options.deskew = deskew
    options.per_frame = per_frame
    options.set_crs(os.fspath(crs))
    options.set_drop_invalid(drop_invalid)
    options.set_sidecar(sidecar)
