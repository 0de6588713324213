# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Disparity and depth of rectified stereo pairs."""

from __future__ import annotations

import enum
from dataclasses import dataclass, fields
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error, shown
from ._inputs import MAX_UINT32, number_of, numbers, one_of, whole

_CENSUS = ("9x9", "7x7", "7x7-symmetric")
_SUBPIXEL = ("v", "parabola", "none")
_ALLOWED = "an array rows x columns of uint8 or uint16"
FloatImage: TypeAlias = npt.NDArray[np.float32]
ByteImage: TypeAlias = npt.NDArray[np.uint8]


class StereoStatus(enum.IntEnum):
    """Why a pixel has a disparity or none: the first test that it fails."""

    valid = 0
    border = 1
    no_texture = 2
    saturated = 3
    out_of_range = 4
    ambiguous = 5
    left_right = 6


@dataclass(frozen=True)
class StereoOptions:
    """Options of ``match_stereo()`` (docs/stereo.md)."""

    min_disparity_px: int = 0
    """Least disparity searched, px."""
    disparities: int = 128
    """Number of disparities searched."""
    census: str = "7x7"
    """Pixels compared: "9x9", "7x7" (each with the centre) or "7x7-symmetric" (opposite ones)."""
    box_px: int = 5
    """Odd side of the window over which costs are summed, px."""
    paths: int = 8
    """4: rows and columns; 8: diagonals too."""
    p1: float = 4.0
    """Penalty of a step of 1 px along a path, bits per pixel of the box."""
    p2: float = 16.0
    """Penalty of a larger step, bits per pixel of the box; at least ``p1``."""
    subpixel: str = "v"
    """Curve through three costs: "v", "parabola" or "none"."""
    a_factor: float = 0.04
    """Adds this times sin(2 pi fraction), px."""
    uniqueness_percent: int = 15
    """How much more than the winner other disparities must cost; 0: no test."""
    has_left_right_test: bool = True
    """Whether the right view must select the same disparity."""
    left_right_px: int = 1
    """Greatest difference of both views, px."""
    min_texture: float = 0.5
    """Mean step of grey levels between neighbouring columns of the window; 0: no test."""
    saturation_level: int = 0
    """Grey level of saturated pixels; 0: the greatest of the arrays' type."""
    steps_per_px: int = 32
    """Disparities are multiples of 1 / this; 0: not rounded."""


@dataclass(frozen=True)
class StereoMatch:
    """The result of ``match_stereo()``, for each pixel of the left image."""

    disparity_px: FloatImage
    """Rows x columns: column in the left minus that in the right image; NaN in holes."""
    status: ByteImage
    """Rows x columns: a ``StereoStatus``."""
    costs: npt.NDArray[np.uint16] | None
    """Rows x columns x disparities, from ``min_disparity_px``: path costs summed; None unless requested."""
    min_disparity_px: int

    def depth_m(self, *, focal_length_px: float, baseline_m: float, column_offset_px: float = 0.0,
                depth_unit_m: float = 0.001) -> FloatImage:
        """Depth along the boresight of the left camera, z = f b / (disparity + offset), m; NaN in holes.

        Args:
            focal_length_px: of both rectified images.
            baseline_m: distance of the cameras, m.
            column_offset_px: principal column of the right minus that of the left image.
            depth_unit_m: depths are multiples of this; 0: not rounded.

        Raises:
            Error: a number that is not allowed.
        """
        numbers_given = (("focal_length_px", focal_length_px), ("baseline_m", baseline_m),
                         ("column_offset_px", column_offset_px), ("depth_unit_m", depth_unit_m))
        values = [number_of(value, name) for name, value in numbers_given]
        result: FloatImage = _core.stereo_depth(np.ascontiguousarray(self.disparity_px), *values)
        return result


@dataclass(frozen=True)
class StereoTest:
    """One test of a pixel."""

    name: str
    """The status of a pixel that fails it."""
    passed: bool
    finding: str
    """The numbers that were compared."""


@dataclass(frozen=True)
class StereoTrace:
    """How a pixel got its disparity or status. ``str`` is what ``glidar depth stereo --explain`` prints."""

    status: StereoStatus
    winner_px: int
    """Disparity of the least summed cost."""
    right_winner_px: int
    """Disparity that the right image selects there."""
    offset_px: float
    """Minimum of the curve through three costs, from the winner."""
    corrected_offset_px: float
    """The same with the a-factor."""
    disparity_px: float
    """Rounded; also of a pixel that fails a test."""
    tests: tuple[StereoTest, ...]
    matching_cost: npt.NDArray[np.uint16]
    """Hamming distances summed over the box, for each disparity."""
    summed_cost: npt.NDArray[np.uint16]
    """Path costs summed over the paths, for each disparity."""
    text: str

    def __str__(self) -> str:
        return self.text


def _core_options(options: StereoOptions) -> _core.StereoOptions:
    if not isinstance(options, StereoOptions):
        raise Error("options", shown(options), "glidar.StereoOptions")
    result = _core.StereoOptions()
    for field in fields(options):
        value: Any = getattr(options, field.name)
        where = f"stereo option {field.name}"
        if field.name in ("census", "subpixel"):
            words = _CENSUS if field.name == "census" else _SUBPIXEL
            value = words.index(one_of(value, where, words))
        elif isinstance(field.default, bool):
            value = bool(value)
        elif isinstance(field.default, int):
            value = whole(value, where, MAX_UINT32)
        else:
            value = number_of(value, where)
        setattr(result, field.name, value)
    return result


def _images(left: object, right: object) -> tuple[npt.NDArray[Any], npt.NDArray[Any], int]:
    """Both images as uint16 in C order, and the greatest level of their type."""
    arrays = []
    for value, where in ((left, "left image"), (right, "right image")):
        array = numbers(value, where, (None, None), _ALLOWED)
        if array.dtype not in (np.uint8, np.uint16):
            raise Error(where, f"an array of {array.dtype}", _ALLOWED, "scale it to grey levels of uint8 or uint16")
        if array.ndim != 2:
            raise Error(where, f"an array of {array.ndim} dimensions", _ALLOWED, "convert colours to grey levels")
        arrays.append(array)
    if arrays[0].dtype != arrays[1].dtype:
        raise Error("right image", f"an array of {arrays[1].dtype}, the left one of {arrays[0].dtype}", "equal types")
    max_level = int(np.iinfo(arrays[0].dtype).max)
    return np.ascontiguousarray(arrays[0], np.uint16), np.ascontiguousarray(arrays[1], np.uint16), max_level


def match_stereo(left: npt.ArrayLike, right: npt.ArrayLike, options: StereoOptions = StereoOptions(), *,
                 costs: bool = False, threads: int = 0) -> StereoMatch:
    """Disparities of a rectified pair by semi-global matching of census transforms.

    Costs are integers, so the result is the same for every number of threads and instruction set.
    Sources: Hirschmueller 2008 (semi-global matching), Zabih and Woodfill 1994 (census).

    Args:
        left: grey levels, rows x columns, uint8 or uint16, with any strides.
        right: the same for the right camera, of equal size and type.
        options: search, costs and tests.
        costs: whether to return the summed costs too.
        threads: number of threads; 0: one per processor.

    Raises:
        Error: images of other types or sizes, or an option that is not allowed.

    Example:
        >>> match = glidar.match_stereo(*glidar.sample_stereo_pair())
        >>> float(match.disparity_px[90, 190]), glidar.StereoStatus(match.status[90, 5]).name
        (36.0, 'border')
    """
    first, second, max_level = _images(left, right)
    disparity, status, cost = _core.match_stereo(first, second, max_level, _core_options(options), bool(costs),
                                                 whole(threads, "threads", 4096))
    return StereoMatch(disparity, status, cost, options.min_disparity_px)


def explain_stereo(left: npt.ArrayLike, right: npt.ArrayLike, options: StereoOptions = StereoOptions(), *,
                   column: int, row: int) -> StereoTrace:
    """Matches the pair and reports the costs and tests of one pixel of the left image.

    Args:
        left, right, options: as for ``match_stereo()``.
        column, row: the pixel, from 0.

    Raises:
        Error: as ``match_stereo()``, or the pixel is outside the image.
    """
    first, second, max_level = _images(left, right)
    found = _core.explain_stereo(first, second, max_level, _core_options(options),
                                 whole(column, "column", MAX_UINT32), whole(row, "row", MAX_UINT32))
    found["status"] = StereoStatus(found["status"])
    found["tests"] = tuple(StereoTest(*test) for test in found["tests"])
    return StereoTrace(**found)


def sample_stereo_pair() -> tuple[ByteImage, ByteImage]:
    """A generated pair of 320x200 pixels, to try the matcher: a plane at 12 px and a disc at 36 px, with a patch
    without texture and a saturated one. Every call returns the same pair."""
    left, right = _core.sample_stereo_pair()
    return left, right
