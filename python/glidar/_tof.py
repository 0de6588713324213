# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Ranges from raw images of continuous-wave time-of-flight cameras."""

from __future__ import annotations

import enum
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error, shown
from ._inputs import MAX_UINT32, number_of, numbers, one_of, shape_text, whole

_UNWRAPPING = ("best_fit", "kinect_v2")
_RAW = "an array frequencies x phase steps x rows x columns of real numbers"
FloatImage: TypeAlias = npt.NDArray[np.float32]
DoubleImage: TypeAlias = npt.NDArray[np.float64]
ByteImage: TypeAlias = npt.NDArray[np.uint8]


class TofStatus(enum.IntEnum):
    """Why a pixel has a range or none: the first test that it fails."""

    valid = 0
    not_illuminated = 1
    saturated = 2
    low_signal = 3
    ambiguous = 4
    too_near = 5
    too_far = 6
    edge = 7


@dataclass(frozen=True)
class TofMisfitTest:
    """The greatest misfit of the unwrapped phases, scale A^exponent between two bounds, with the greatest amplitude A
    of the frequencies (the least one for an exponent above 0)."""

    min_rad: float = 0.61
    max_rad: float = 0.61
    scale: float = 1.0
    exponent: float = 0.0


@dataclass(frozen=True)
class TofFilter:
    """Smoothing of the complex amplitudes over 3x3 pixels (docs/time-of-flight.md)."""

    min_amplitude: float = 0.0
    """Neighbours below it have no weight."""
    phase_weight: float = 7.213475
    """Weights are exp(-phase_weight (1 - cos d) / 2), d the difference of the phases."""
    max_phase_change: float = 2.5
    """From this sum of (1 - cos d) / 2 on, the pixel is at an edge."""


@dataclass(frozen=True)
class TofEdgeTest:
    """A pixel is at an edge if all of these are exceeded in its 3x3 pixels."""

    amplitude_deviation: float = 0.0
    """Standard deviation over mean of the amplitude."""
    min_mean_amplitude: float = 0.0
    """The mean counts as at least this."""
    near_step_m: float = 0.05
    """Step to the nearest depth, m."""
    far_step_m: float = 0.03
    """Step to the farthest depth, m."""
    max_step_m: float = 0.1
    """The greater of both, m."""
    mean_step_m: float = 0.0
    """Their mean, m."""


@dataclass(frozen=True)
class TofOptions:
    """Options of ``decode_tof()`` (docs/time-of-flight.md)."""

    frequencies_hz: Iterable[float] = ()
    """Modulation frequencies, 1 to 8 in simple ratios, Hz."""
    taps: int = 4
    """Phase steps of each frequency, 3 to 16."""
    amplitude_gain: Iterable[float] = ()
    """Factors of the amplitudes, one for each frequency; empty: 1."""
    saturation_level: float = float("inf")
    """Raw values of this magnitude or above are saturated."""
    unwrapping: str = "best_fit"
    """"best_fit", or "kinect_v2" as libfreenect2 does."""
    min_amplitude: float = 0.0
    """Of every frequency."""
    min_amplitude_sum: float = 0.0
    """Over all frequencies."""
    misfit_test: TofMisfitTest = TofMisfitTest()
    filter: TofFilter | None = None
    edge_test: TofEdgeTest | None = None
    near_m: float = 0.0
    """Least depth, m."""
    far_m: float = float("inf")
    """Greatest depth, m."""

    @staticmethod
    def kinect_v2() -> TofOptions:
        """The options of libfreenect2 for the Kinect v2 (OpenKinect/libfreenect2, DepthPacketProcessor)."""
        given = _core.kinect_v2_options()
        values: dict[str, Any] = {field.name: getattr(given, field.name) for field in fields(TofOptions)}
        values["unwrapping"] = _UNWRAPPING[given.unwrapping]
        values["frequencies_hz"] = tuple(given.frequencies_hz)
        values["amplitude_gain"] = tuple(given.amplitude_gain)
        for name, kind in _NESTED.items():
            core = values[name]
            values[name] = kind(**{field.name: getattr(core, field.name) for field in fields(kind)})
        return TofOptions(**values)


_NESTED: dict[str, Any] = {"misfit_test": TofMisfitTest, "filter": TofFilter, "edge_test": TofEdgeTest}


@dataclass(frozen=True)
class TofMeasurement:
    """The result of ``decode_tof()``."""

    range_m: DoubleImage
    """Rows x columns, along each pixel's beam, m; NaN unless the status is valid."""
    status: ByteImage
    """Rows x columns: a ``TofStatus``."""
    amplitude: FloatImage
    """Frequencies x rows x columns, with ``amplitude_gain``, after the filter."""
    phase_rad: FloatImage
    """Frequencies x rows x columns, in [0, 2 pi), after the filter."""
    misfit_rad: FloatImage
    """Rows x columns: distance of the phases from those of the range; NaN where the signal is low or saturated."""


@dataclass(frozen=True, eq=False)
class TofFrame:
    """Raw images of a frame, from which its ranges were decoded, and their ground truth."""

    images: FloatImage
    """Frequencies x phase steps x rows x columns, for ``decode_tof()``; infinite: saturated."""
    amplitude: FloatImage
    """Rows x columns, active brightness: amplitude, mean of the frequencies, in levels of ``images``."""
    bounced_share: FloatImage
    """Rows x columns, ground truth: share of the modulated light that came over diffuse bounces."""


@dataclass(frozen=True)
class TofTest:
    """One test of a pixel."""

    name: str
    """The status of a pixel that fails it."""
    passed: bool
    finding: str
    """The numbers that were compared."""


@dataclass(frozen=True)
class TofCandidate:
    """A choice of whole periods."""

    range_m: float
    misfit_rad: float
    periods: tuple[int, ...]
    """Whole periods of each frequency."""


@dataclass(frozen=True)
class TofTrace:
    """How a pixel got its range or status. ``str`` is the same as text."""

    status: TofStatus
    range_m: float
    """Also of a pixel that fails a test."""
    depth_m: float
    misfit_rad: float
    levels: DoubleImage
    """Frequencies x phase steps: the raw values."""
    amplitude: DoubleImage
    """Of each frequency, after the filter."""
    phase_rad: DoubleImage
    """Of each frequency, after the filter."""
    tests: tuple[TofTest, ...]
    candidates: tuple[TofCandidate, ...]
    """Least misfit first."""
    text: str

    def __str__(self) -> str:
        return self.text


def _core_struct(value: object, kind: type, where: str) -> Any:
    if not isinstance(value, kind):
        raise Error(where, shown(value), f"glidar.{kind.__name__}")
    result = getattr(_core, kind.__name__)()
    for field in fields(kind):
        setattr(result, field.name, number_of(getattr(value, field.name), f"{where}.{field.name}"))
    return result


def _core_options(options: TofOptions) -> _core.TofOptions:
    if not isinstance(options, TofOptions):
        raise Error("options", shown(options), "glidar.TofOptions")
    result = _core.TofOptions()
    for field in fields(options):
        value: Any = getattr(options, field.name)
        where = f"time-of-flight option {field.name}"
        if field.name in _NESTED:
            value = None if value is None and field.name != "misfit_test" else _core_struct(value, _NESTED[field.name], where)
        elif field.name in ("frequencies_hz", "amplitude_gain"):
            value = [number_of(one, where) for one in numbers(value, where, (None, )).ravel()]
        elif field.name == "unwrapping":
            value = _UNWRAPPING.index(one_of(value, where, _UNWRAPPING))
        elif field.name == "taps":
            value = whole(value, where, MAX_UINT32)
        else:
            value = number_of(value, where)
        setattr(result, field.name, value)
    return result


def _levels(raw: object) -> FloatImage:
    array = numbers(raw, "raw images", (None, None, None, None), _RAW)
    if array.ndim != 4 or array.dtype.kind not in "fiu":
        raise Error("raw images", f"an array {shape_text(array.shape)} of {array.dtype}", _RAW)
    return np.ascontiguousarray(array, np.float32)


def _per_pixel(value: object, where: str, shape: tuple[int, ...], dtype: Any) -> npt.NDArray[Any] | None:
    if value is None:
        return None
    array = numbers(value, where, shape)
    if array.shape != shape or array.dtype.kind not in "fiub":
        raise Error(where, f"an array {shape_text(array.shape)} of {array.dtype}", f"an array {shape_text(shape)}")
    return np.ascontiguousarray(array, dtype).ravel()


def _calibration(levels: FloatImage, depth_per_range: object, phase_offset_rad: object,
                 is_illuminated: object) -> tuple[Any, Any, Any]:
    image = levels.shape[2:]
    lit = None if is_illuminated is None else numbers(is_illuminated, "is_illuminated", image) != 0
    return (_per_pixel(depth_per_range, "depth_per_range", image, np.float32),
            _per_pixel(phase_offset_rad, "phase_offset_rad", (levels.shape[0], *image), np.float32),
            _per_pixel(lit, "is_illuminated", image, np.uint8))


def decode_tof(raw: npt.ArrayLike, options: TofOptions, *, depth_per_range: npt.ArrayLike | None = None,
               phase_offset_rad: npt.ArrayLike | None = None, is_illuminated: npt.ArrayLike | None = None,
               threads: int = 0) -> TofMeasurement:
    """Ranges from the raw images of a continuous-wave camera.

    Phase step k of N measures A cos(phi - 2 pi k / N) plus a constant, with phi = 4 pi f R / c. Source: Lange and
    Seitz, IEEE J. Quantum Electronics 37 (2001). The result is the same for every number of threads.

    Args:
        raw: frequencies x phase steps x rows x columns, in any unit; infinite: saturated.
        options: frequencies, unwrapping, filter and tests.
        depth_per_range: rows x columns, cosine between the pixel's beam and the boresight; default 1.
        phase_offset_rad: frequencies x rows x columns, subtracted from the phases; default 0.
        is_illuminated: rows x columns, zero where the illuminator does not light the image; default 1.
        threads: number of threads; 0: one per processor.

    Raises:
        Error: arrays of other shapes, or an option that is not allowed.

    Example:
        >>> raw, depth_per_range, is_illuminated = glidar.sample_tof_images()
        >>> measured = glidar.decode_tof(raw, glidar.TofOptions.kinect_v2(), depth_per_range=depth_per_range)
        >>> round(float(measured.range_m[60, 80]), 2), glidar.TofStatus(measured.status[97, 48]).name
        (1.2, 'low_signal')
    """
    levels = _levels(raw)
    calibration = _calibration(levels, depth_per_range, phase_offset_rad, is_illuminated)
    return TofMeasurement(*_core.decode_tof(levels, _core_options(options), *calibration, whole(threads, "threads", 4096)))


def explain_tof(raw: npt.ArrayLike, options: TofOptions, *, column: int, row: int,
                depth_per_range: npt.ArrayLike | None = None, phase_offset_rad: npt.ArrayLike | None = None,
                is_illuminated: npt.ArrayLike | None = None) -> TofTrace:
    """Decodes the images and reports raw values, phases, candidates and tests of one pixel.

    Args:
        raw, options, depth_per_range, phase_offset_rad, is_illuminated: as for ``decode_tof()``.
        column, row: the pixel, from 0.

    Raises:
        Error: as ``decode_tof()``, or the pixel is outside the image.
    """
    levels = _levels(raw)
    calibration = _calibration(levels, depth_per_range, phase_offset_rad, is_illuminated)
    found = _core.explain_tof(levels, _core_options(options), calibration, whole(column, "column", MAX_UINT32),
                              whole(row, "row", MAX_UINT32))
    found["status"] = TofStatus(found["status"])
    found["tests"] = tuple(TofTest(*test) for test in found["tests"])
    found["candidates"] = tuple(TofCandidate(range_m, misfit_rad, tuple(int(p) for p in periods))
                                for range_m, misfit_rad, periods in found["candidates"])
    for name in ("levels", "amplitude", "phase_rad"):
        found[name] = np.array(found[name])
    return TofTrace(**found)


def tof_frame(core: _core.Frame) -> TofFrame | None:
    """What a frame of a time-of-flight camera has besides its ranges."""
    images, amplitude, bounced = (_core.frame_tof_images(core), core.measured("tof_amplitude"),
                                  core.measured("bounced_share"))
    if images is None or amplitude is None or bounced is None:
        return None
    return TofFrame(images, amplitude, bounced)


def sample_tof_images() -> tuple[FloatImage, FloatImage, ByteImage]:
    """Generated raw images of a Kinect v2 of 160x120 pixels, to try the decoder, with their ``depth_per_range`` and
    ``is_illuminated``: a tilted wall, a disc before it, a dark and a retroreflecting patch, and corners without light.
    Every call returns the same images."""
    raw, depth_per_range, is_illuminated = _core.sample_tof_images()
    return raw, depth_per_range, is_illuminated
