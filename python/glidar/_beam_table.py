# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Optics whose beams are given as arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import Error, shown
from ._inputs import MAX_UINT32, floats, numbers, shape_text, whole
from ._state import part

_TABLE_ARRAYS = {"directions": 3, "origins_m": 3, "times_ns": 1, "rings": 1}  # numbers per beam
_TABLE_KEYS = {"type", "period_ns", *_TABLE_ARRAYS}


def _shape(name: str, rows: int, cols: int) -> tuple[int, ...]:
    return (rows, cols, 3) if _TABLE_ARRAYS[name] == 3 else (rows, cols)


def _per_beam(value: object, name: str, shape: tuple[int, ...]) -> npt.NDArray[Any]:
    """An array of a beam table, flattened to one row per beam."""
    given = numbers(value, f"optics.{name}", shape)
    if given.shape != shape or given.dtype.kind not in "fiu":
        found = f"an array {shape_text(given.shape)} of {given.dtype}"
        raise Error(f"optics.{name}", found, f"an array {shape_text(shape)} of real numbers")
    if name == "rings":
        if given.dtype.kind not in "iu" or given.min() < 0 or given.max() > 65535:
            raise Error("optics.rings", f"an array of {given.dtype}", "whole numbers from 0 to 65535")
        return np.ascontiguousarray(given, np.uint16).reshape(-1)
    rows = np.ascontiguousarray(given, np.float64)
    return rows.reshape(-1, 3) if len(shape) == 3 else rows.reshape(-1)


def table_of_optics(optics: Mapping[str, Any]) -> dict[str, Any]:
    """Checks optics whose beams are given as arrays and converts them for the extension."""
    unknown = [key for key in optics if key not in _TABLE_KEYS]
    if unknown:
        raise Error("optics", f"the unknown key {unknown[0]!r}", ", ".join(sorted(_TABLE_KEYS)))
    if optics.get("type") != "table":
        raise Error("optics.type", shown(optics.get("type")), "'table' for optics with directions")
    shape = numbers(optics["directions"], "optics.directions", (None, None, 3)).shape
    if len(shape) != 3 or shape[2] != 3 or min(shape) == 0:
        raise Error("optics.directions", f"an array {shape_text(shape)}", "an array rows x cols x 3")
    table: dict[str, Any] = {"shape": (shape[0], shape[1])}
    table["period_ns"] = float(floats(optics.get("period_ns", 0.0), "optics.period_ns", ()))
    for name in _TABLE_ARRAYS:
        if optics.get(name) is not None:
            table[name] = _per_beam(optics[name], name, _shape(name, *shape[:2]))
    return table


def stored_table(table: dict[str, Any]) -> dict[str, Any]:
    """The table of a pickled sensor, checked like user input."""
    rows, cols = (whole(size, "shape", MAX_UINT32) for size in part(table, "shape", tuple))
    optics: dict[str, Any] = {"type": "table", "period_ns": table["period_ns"]}
    for name in _TABLE_ARRAYS:
        if table[name] is not None:
            optics[name] = part(table, name, np.ndarray).reshape(_shape(name, rows, cols))
    return table_of_optics(optics)


def optics_of_table(table: Mapping[str, Any]) -> dict[str, Any]:
    """Optics in the format of sensor files from the extension's table; the arrays are copies."""
    rows, cols = table["shape"]
    optics: dict[str, Any] = {"type": "table", "period_ns": table["period_ns"]}
    for name in _TABLE_ARRAYS:
        if table[name] is not None:
            optics[name] = np.array(table[name]).reshape(_shape(name, rows, cols))
    return optics
