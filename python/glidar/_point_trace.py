# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""How an entry of a frame came to be."""

from __future__ import annotations

from dataclasses import dataclass

from . import _core
from ._inputs import FloatArray
from ._state import SameContent
from ._status import ReturnSource, Status


@dataclass(frozen=True, eq=False)
class Measurement(SameContent):
    """What the sensor would report at some point of its measurement."""

    status: Status
    return_source: ReturnSource
    range_m: float
    """NaN unless status is hit."""
    intensity: float
    sigma_m: float


@dataclass(frozen=True, eq=False)
class RandomSample(SameContent):
    """A random number that a step of noise took."""

    law: str
    """"normal" (mean 0, deviation 1) or "uniform" (0 to 1)."""
    value: float
    use: str
    """What the step did with it."""
    against: float | None
    """Of a chance: the probability that it is held against."""


@dataclass(frozen=True, eq=False)
class NoiseStep(SameContent):
    """One step of noise."""

    drawn: tuple[RandomSample, ...]
    after: Measurement


@dataclass(frozen=True, eq=False)
class Echo(SameContent):
    """A peak of the light of a pulse that came back and was told from noise."""

    range_m: float
    signal: float
    """In units of the detection threshold."""
    sigma_m: float
    is_mixed: bool


@dataclass(frozen=True, eq=False)
class PointTrace(SameContent):
    """How an entry of a frame came to be; ``str`` tells it in words, as ``glidar explain`` does."""

    entry: int
    direction: FloatArray
    """Of the beam with its errors of pointing, in the sensor's frame (3)."""
    measured: Measurement
    """Before noise."""
    steps: tuple[NoiseStep, ...]
    """One for each step of the sensor's noise."""
    echoes: tuple[Echo, ...]
    """Of pulsed light whose beams are more than a ray; else none."""
    text: str

    def __str__(self) -> str:
        return self.text


def _measurement(core: _core.Measurement) -> Measurement:
    return Measurement(Status(core.status), ReturnSource(core.return_source), core.range_m, core.intensity, core.sigma_m)


def _sample(core: _core.RandomSample) -> RandomSample:
    return RandomSample("normal" if core.is_normal else "uniform", core.value, core.use, core.against)


def trace_of(core: _core.PointTrace) -> PointTrace:
    """The story that the library tells."""
    measured, *after = (_measurement(reading) for reading in core.readings)
    steps = (NoiseStep(tuple(_sample(drawn) for drawn in core.draws(k)), reading) for k, reading in enumerate(after))
    echoes = (Echo(echo.range_m, echo.signal, echo.sigma_m, echo.is_mixed) for echo in core.echoes)
    return PointTrace(core.entry, core.direction, measured, tuple(steps), tuple(echoes), core.text)
