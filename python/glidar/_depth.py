# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Depth images: the filters of drivers of depth cameras, and the pixels of a colour camera."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error, shown
from ._inputs import floats, numbers, path_of
from ._sensor import plain

_ALLOWED = "an array rows x columns of uint16, or of floating-point metres"
_MAX_UNITS = 65535


def _filter(value: object, index: int) -> dict[str, Any]:
    if isinstance(value, str):
        return {"type": value}
    if isinstance(value, Mapping):
        return dict(value)
    raise Error(f"filters[{index}]", shown(value), "the name of a filter, or a dict with its keys")


def json_text(description: object, where: str) -> str:
    """A description of plain values as the library reads it."""
    return json.dumps(plain(description, where), ensure_ascii=False)


def _units(depth: npt.NDArray[Any], unit_m: float) -> npt.NDArray[np.uint16]:
    """Multiples of the unit, 0 for NaN and for depths of less than half a unit or beyond 16 bits."""
    with np.errstate(invalid="ignore"):
        units = np.floor(depth.astype(np.float64) / unit_m + 0.5)
        return np.where((units > 0) & (units <= _MAX_UNITS), units, 0).astype(np.uint16)


def _metres(units: npt.NDArray[np.uint16], unit_m: float) -> npt.NDArray[np.float32]:
    return np.where(units > 0, units * unit_m, np.nan).astype(np.float32)


def _depth_array(depth: npt.ArrayLike) -> npt.NDArray[Any]:
    array = numbers(depth, "depth", (None, None), _ALLOWED)
    if array.ndim != 2 or not (array.dtype == np.uint16 or array.dtype.kind == "f"):
        raise Error("depth", f"an array of {array.ndim} dimensions of {array.dtype}", _ALLOWED)
    return array


class DepthFilters:
    """Filters that change the depth images of one camera, with the results of librealsense (docs/depth-filters.md).

    Args:
        filters: in their order; each its name, or a dict with its keys: ``{"type": "spatial", "alpha": 0.6}``.
        focal_length_px: of the images before the filters, along rows; needed by ``to_disparity``.
        depth_unit_m: unit of depths.

    Raises:
        Error: an unknown filter or key, a value out of range, or a filter at the wrong place.

    Example:
        >>> filters = glidar.DepthFilters(["spatial", {"type": "hole_filling", "source": "nearest"}])
        >>> filters.apply(np.array([[1000, 1010], [1000, 0], [1000, 1000]], np.uint16))
        array([[1003, 1005],
               [1002, 1002],
               [1001, 1001]], dtype=uint16)
    """

    __slots__ = ("_core", "_unit_m")

    def __init__(self, filters: Iterable[str | Mapping[str, Any]], *, focal_length_px: float = 0.0,
                 depth_unit_m: float = 0.001) -> None:
        if isinstance(filters, (str, Mapping)) or not isinstance(filters, Iterable):
            raise Error("filters", shown(filters), "a list of filters")
        text = json_text({"depth_filters": [_filter(value, i) for i, value in enumerate(filters)]}, "filters")
        self._unit_m = float(floats(depth_unit_m, "depth_unit_m", ()))
        self._core = _core.DepthFilterChain(text, float(floats(focal_length_px, "focal_length_px", ())), self._unit_m)

    def apply(self, depth: npt.ArrayLike) -> npt.NDArray[Any]:
        """The next image, filtered.

        The temporal filter mixes it with the images before; an image of another size is the first again.

        Args:
            depth: rows x columns: uint16 multiples of the unit, 0 for none; or floating-point metres, NaN for none.

        Returns:
            uint16, or float32 metres if the image has metres. ``decimation`` makes it smaller.

        Raises:
            Error: an array of another type or shape.
        """
        array = _depth_array(depth)
        if array.dtype == np.uint16:
            result: npt.NDArray[Any] = self._core.apply(np.ascontiguousarray(array))
            return result
        return _metres(self._core.apply(_units(array, self._unit_m)), self._unit_m)

    def reset(self) -> None:
        """Forgets all images: the next one is the first."""
        self._core.reset()


def recommended_depth_filters(baseline_m: float = 0.0) -> list[dict[str, Any]]:
    """The filters in the order that librealsense recommends, with all their keys and defaults.

    Args:
        baseline_m: distance of the cameras of a stereo camera, whose disparities the spatial and temporal filters
            then change; 0: they change depths.
    """
    text = _core.recommended_depth_filters(float(floats(baseline_m, "baseline_m", ())))
    filters: list[dict[str, Any]] = json.loads(text)["depth_filters"]
    return filters


@dataclass(frozen=True)
class AlignedDepth:
    """A depth image with the pixels of a colour camera."""

    depth: npt.NDArray[Any]
    """Rows x columns of the colour camera, in the type of the depth image: uint16 units, or float32 metres."""
    source: npt.NDArray[np.int64]
    """Rows x columns: the pixel of the depth image (row x columns + column) that each depth is from; -1 for none."""

    def take(self, values: npt.ArrayLike, missing: Any = 0) -> npt.NDArray[Any]:
        """Other values of the depth image's pixels, such as classes, for the pixels of the colour camera.

        Args:
            values: rows x columns of the depth camera, with any further dimensions.
            missing: the value of pixels without depth.
        """
        array = numbers(values, "values", (None, None))
        flat = array.reshape(-1, *array.shape[2:])
        if array.ndim < 2 or self.source.max(initial=-1) >= len(flat):
            raise Error("values", f"an array of shape {array.shape}", "one value for each pixel of the depth image")
        taken = flat[np.maximum(self.source, 0)]
        taken[self.source < 0] = missing
        return taken


class DepthAligner:
    """Moves depth images to the pixels of a colour camera (docs/depth-filters.md), as rs.align of librealsense does.

    Args:
        cameras: a file with both cameras and their poses, or a dict with its keys: ``depth`` and ``colour`` with the
            keys of pinhole optics in sensor files, ``colour_from_depth`` with those of a pose, ``depth_unit_mm``,
            ``keeps_depth``.

    Raises:
        Error: an unknown or missing key, or a value out of range.
    """

    __slots__ = ("_core", "_unit_m")

    def __init__(self, cameras: str | os.PathLike[str] | Mapping[str, Any]) -> None:
        if isinstance(cameras, Mapping):
            self._core = _core.DepthAligner(json_text(cameras, "cameras"), False)
        else:
            self._core = _core.DepthAligner(path_of(cameras, "cameras"), True)
        self._unit_m = self._core.unit_m

    def align(self, depth: npt.ArrayLike) -> AlignedDepth:
        """The depths that the colour camera sees.

        Args:
            depth: rows x columns of the depth camera: uint16 multiples of the unit, 0 for none; or floating-point
                metres, NaN for none.

        Raises:
            Error: an array of another type or size.
        """
        array = _depth_array(depth)
        is_metres = array.dtype != np.uint16
        units = _units(array, self._unit_m) if is_metres else np.ascontiguousarray(array)
        aligned, source = self._core.align(units)
        pixels = np.where(source == _core.NO_SOURCE, -1, source.astype(np.int64))
        return AlignedDepth(_metres(aligned, self._unit_m) if is_metres else aligned, pixels)
