# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The trace of one entry of a frame through the measurement."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error
from ._inputs import FloatArray, whole
from ._state import SameContent
from ._status import ReturnSource, Status


@dataclass(frozen=True, eq=False)
class Measurement(SameContent):
    """The values of an entry at one stage of the measurement."""

    status: Status
    return_source: ReturnSource
    range_m: float
    """Measured distance along the beam from its origin, m, without the sensor's range offset; NaN unless status
    is hit."""
    intensity: float
    sigma_m: float
    """Standard deviation of the range, m."""
    radial_velocity_m_s: float
    """Measured radial velocity, m/s; NaN unless status is hit and the sensor measures it."""


@dataclass(frozen=True, eq=False)
class RandomSample(SameContent):
    """A random number that a noise step used."""

    distribution: str
    """"normal" (mean 0, deviation 1) or "uniform" (0 to 1)."""
    value: float
    use: str
    """What the noise step used it for."""
    probability: float | None
    """The probability that a uniform number is compared with; None when there is no such comparison."""


@dataclass(frozen=True, eq=False)
class NoiseStep(SameContent):
    """The effect of one noise step."""

    samples: tuple[RandomSample, ...]
    """The random numbers that it used."""
    after: Measurement
    """The values after this step."""


@dataclass(frozen=True, eq=False)
class Echo(SameContent):
    """A peak of the received waveform that was detected above the noise."""

    range_m: float
    """Distance along the beam, m."""
    signal: float
    """Received signal in units of the detection threshold."""
    sigma_m: float
    """Width of the echo as a standard deviation, m."""
    is_mixed: bool
    """Whether it merges the light of several surfaces."""


@dataclass(frozen=True, eq=False)
class PointTrace(SameContent):
    """How the measurement of an entry arose. ``str`` is the text that ``glidar explain`` prints."""

    entry: int
    """Index of the entry: row * cols + col."""
    direction: FloatArray
    """(3,): direction of the beam with its pointing error, unit vector in the sensor's coordinate frame."""
    measured: Measurement
    """The values before noise."""
    steps: tuple[NoiseStep, ...]
    """One for each noise step of the sensor."""
    reported: Measurement
    """The values after all steps, if they are within the limits."""
    echoes: tuple[Echo, ...]
    """Echoes of pulsed sensors with footprints, mirrors or several returns; else empty."""
    text: str
    """The trace as text."""

    def __str__(self) -> str:
        return self.text


def _measurement(core: _core.Measurement) -> Measurement:
    return Measurement(
        Status(core.status),
        ReturnSource(core.return_source),
        core.range_m,
        core.intensity,
        core.sigma_m,
        core.radial_velocity_m_s,
    )


def _sample(core: _core.RandomSample) -> RandomSample:
    return RandomSample("normal" if core.is_normal else "uniform", core.value, core.use, core.probability)


def entry_of(
    status: npt.NDArray[np.uint8], index: int | None, row: int | None, col: int | None, drop_invalid: bool
) -> int:
    """The number of an entry of a frame with these statuses: of a point of its cloud, or at a row and a column."""
    if index is None and row is not None and col is not None:
        rows, cols = status.shape
        return int(whole(row, "row", rows - 1) * cols + whole(col, "col", cols - 1))
    if index is None or row is not None or col is not None:
        raise Error("explain", "a point is given twice or not at all", "index, or row and col")
    if not drop_invalid:
        return whole(index, "index", status.size - 1)
    entries = np.flatnonzero(status == Status.hit)
    if len(entries) == 0:
        raise Error("index", f"{index}", "", "the frame has no hits")
    return int(entries[whole(index, "index", len(entries) - 1)])


def trace_of(core: _core.PointTrace) -> PointTrace:
    """Converts the trace of the extension."""
    measured, *after, reported = (_measurement(one) for one in core.measurements)
    steps = (NoiseStep(tuple(_sample(sample) for sample in core.samples(k)), one) for k, one in enumerate(after))
    echoes = (Echo(echo.range_m, echo.signal, echo.sigma_m, echo.is_mixed) for echo in core.echoes)
    return PointTrace(core.entry, core.direction, measured, tuple(steps), reported, tuple(echoes), core.text)
