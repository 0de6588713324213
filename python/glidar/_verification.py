# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The accuracy of ranges and normals on this machine."""

from __future__ import annotations

from dataclasses import dataclass

from . import _core
from ._inputs import one_of, whole


@dataclass(frozen=True)
class VerifyRow:
    """One shape at one distance, in all sizes and places (docs/accuracy.md)."""

    shape: str
    distance_m: float
    rays: int
    judged_hits: int
    judged_misses: int
    near_edges: int
    """Not judged."""
    wrong_hits: int
    wrong_misses: int
    range_error_m: float
    """Largest."""
    range_error_ulp: float
    """Largest, in steps of float32 at the true range."""
    normal_error_rad: float
    """Largest."""
    passed: bool


@dataclass(frozen=True)
class Verification:
    """What ``glidar.verify()`` found; true when all is within the bounds."""

    rows: tuple[VerifyRow, ...]

    @property
    def passed(self) -> bool:
        """Ranges within 1 step of float32, normals within 1e-6 rad, no wrong hit, no wrong miss."""
        return all(row.passed for row in self.rows)

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        rays = sum(row.rays for row in self.rows)
        worst = max(row.range_error_ulp for row in self.rows)
        wrong = sum(row.wrong_hits + row.wrong_misses for row in self.rows)
        verdict = "passed" if self.passed else "FAILED"
        return f"{verdict}: {rays} rays, largest range error {worst:.2e} ulp of float32, {wrong} wrong hits or misses"


def verify(*, renderer: str = "auto", threads: int = 0) -> Verification:
    """Measures the accuracy of a renderer on this machine, as ``glidar verify`` does: every shape at
    every distance from 0.1 m to 10 km, judged by its closed form."""
    one_of(renderer, "renderer", ("auto", "embree", "raster", "opengl"))
    names = VerifyRow.__dataclass_fields__
    rows = _core.verify(renderer, whole(threads, "threads", 4096))
    return Verification(tuple(VerifyRow(**{name: getattr(row, name) for name in names}) for row in rows))
