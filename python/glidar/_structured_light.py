# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Structured light: fringe patterns, and depth from images of them."""

from __future__ import annotations

import enum
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._depth import json_text
from ._errors import Error
from ._inputs import MAX_UINT32, numbers, path_of, whole

_ALLOWED = "an array images x rows x columns of uint8 or uint16"


class FringeStatus(enum.IntEnum):
    """Why a pixel has a depth or none: the first test that it fails."""

    valid = 0
    saturated = 1
    low_modulation = 2
    weak_code = 3
    inconsistent = 4
    outside = 5


@dataclass(frozen=True)
class DecodedFringes:
    """What ``StructuredLight.decode()`` finds; all arrays are rows x columns of the camera."""

    depth_m: npt.NDArray[np.float32]
    """Depth along the boresight of the camera, m; NaN in holes."""
    coordinate_px: npt.NDArray[np.float32]
    """Column (or row) of the projector, whole numbers are centres of pixels; NaN in holes."""
    phase_rad: npt.NDArray[np.float32]
    """Phase of the fringes, 0 to 2 pi; NaN without fringes."""
    modulation: npt.NDArray[np.float32]
    """Amplitude of the fringes, grey levels."""
    mean_level: npt.NDArray[np.float32]
    """Mean of the fringes, grey levels."""
    status: npt.NDArray[np.uint8]
    """A ``FringeStatus``."""


@dataclass(frozen=True)
class FringeTest:
    """One test of a pixel."""

    name: str
    """The status of a pixel that fails it."""
    passed: bool
    finding: str
    """The numbers that were compared."""


@dataclass(frozen=True)
class FringeTrace:
    """How a pixel got its coordinate or status, from ``StructuredLight.explain()``. ``str`` lists all of it."""

    status: FringeStatus
    levels: npt.NDArray[np.uint16]
    """Grey level of each image, (images,)."""
    phase_rad: float
    """Phase of the fringes, 0 to 2 pi; 0 without fringes."""
    modulation: float
    """Amplitude of the fringes, grey levels."""
    mean_level: float
    stripe: int
    """Number of the stripe by the Gray code."""
    period: float
    """Whole periods that the stripe selects."""
    code_error: float
    """Difference between phase and code, periods."""
    coordinate_px: float
    """Also of a pixel that fails a test."""
    tests: tuple[FringeTest, ...]
    text: str

    def __str__(self) -> str:
        return self.text


def _level_stack(images: npt.ArrayLike) -> tuple[npt.NDArray[np.uint16], int]:
    """The images, and the greatest level of their type."""
    array = numbers(images, "images", (None, None, None), _ALLOWED)
    if array.ndim != 3 or array.dtype not in (np.uint8, np.uint16):
        raise Error("images", f"an array of {array.ndim} dimensions of {array.dtype}", _ALLOWED)
    return np.ascontiguousarray(array, np.uint16), int(np.iinfo(array.dtype).max)


class StructuredLight:
    """A camera and a projector of phase-shifted fringes with a Gray code (docs/structured-light.md).

    Args:
        setup: a setup file, or a dict with its keys: ``camera`` and ``projector`` with the keys of pinhole optics in
            sensor files, ``projector_from_camera`` with those of a pose, ``patterns``, ``decoding``. Or a sensor file or
            ``sensor.to_dict()`` with a ``depth_camera`` of type "structured_light".

    Raises:
        Error: an unknown or missing key, or a value out of range.
    """

    __slots__ = ("_core",)

    def __init__(self, setup: str | os.PathLike[str] | Mapping[str, Any]) -> None:
        if isinstance(setup, Mapping):
            self._core = _core.StructuredLight(json_text(setup, "setup"), False)
        else:
            self._core = _core.StructuredLight(path_of(setup, "setup"), True)

    def patterns(self) -> npt.NDArray[np.uint8]:
        """The images to be projected, one after the other: images x rows x columns of the projector."""
        result: npt.NDArray[np.uint8] = self._core.patterns()
        return result

    def decode(self, images: npt.ArrayLike, *, threads: int = 0) -> DecodedFringes:
        """Decodes the camera's images of the patterns, and triangulates.

        White noise of standard deviation s in the levels gives the phase one of sqrt(2 / steps) s / modulation.
        Source: Srinivasan, Liu and Halioua 1984.

        Args:
            images: images x rows x columns of the camera, uint8 or uint16, in the order of the patterns.
            threads: number of threads; 0: one per processor. The result is the same for any number.

        Raises:
            Error: images of another type, number or size.
        """
        levels, max_level = _level_stack(images)
        return DecodedFringes(**self._core.decode(levels, max_level, whole(threads, "threads", 4096)))

    def explain(self, images: npt.ArrayLike, *, column: int, row: int) -> FringeTrace:
        """Reports how one pixel of the images is decoded: its grey levels, phase, code and tests.

        Args:
            images: as for ``decode()``.
            column, row: the pixel, from 0.

        Raises:
            Error: as ``decode()``, or the pixel is outside the images.
        """
        levels, max_level = _level_stack(images)
        found = self._core.explain(levels, max_level, whole(column, "column", MAX_UINT32), whole(row, "row", MAX_UINT32))
        found["status"] = FringeStatus(found["status"])
        found["tests"] = tuple(FringeTest(*test) for test in found["tests"])
        return FringeTrace(**found)
