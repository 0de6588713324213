# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Accuracy of a renderer's hits and of what is measured with them on this machine."""

from __future__ import annotations

from dataclasses import dataclass

from . import _core
from ._inputs import one_of, whole


@dataclass(frozen=True)
class AccuracyCase:
    """The result of one test case with one shape at one distance (docs/internals/accuracy.md)."""

    name: str
    """Name of the case, such as "one shape at rest"."""
    shape: str
    distance_m: float
    rays: int
    compared_hits: int
    compared_misses: int
    near_edges: int
    """Rays too close to an edge to be tested."""
    wrong_hits: int
    wrong_misses: int
    wrong_ids: int
    """Hits with another instance, or a triangle that does not contain the true point."""
    range_error_m: float
    """Maximum, m."""
    range_error_ulp: float
    """Maximum, in units in the last place (ulp) of float32 at the true range."""
    normal_error_rad: float
    """Maximum, rad."""
    other_error: float
    """Maximum of the errors of other columns and of measurements, as a share of their bounds."""
    known_failure: str
    """The reason for a known failure of this renderer; empty when the case must pass."""
    verdict: str
    """"passed", "FAILED" (also when a known failure exceeds its bounds), "known failure", "FIXED" (a known
    failure that passes), or "not applicable" (the renderer does not cast such beams)."""

    @property
    def passed(self) -> bool:
        """Whether all errors are within their bounds."""
        return self.verdict == "passed"


@dataclass(frozen=True)
class AccuracyReport:
    """The result of ``glidar.verify()``. It is true when no row has the verdict "FAILED"."""

    rows: tuple[AccuracyCase, ...]

    @property
    def passed(self) -> bool:
        """Whether ranges are within 0.001 ulp of float32, normals within 1e-6 rad, other errors within
        their bounds, and hits, misses and ids correct, except for known failures, which have bounds too."""
        return all(row.verdict != "FAILED" for row in self.rows)

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        good = [row for row in self.rows if row.passed]
        worst = max((row.range_error_ulp for row in good), default=0.0)
        known = sum(row.verdict == "known failure" for row in self.rows)
        bad = [f"{row.name}, {row.shape}, {row.distance_m:g} m: {row.verdict}"
               for row in self.rows if row.verdict == "FAILED"]
        verdict = "passed" if self.passed else "FAILED (" + "; ".join(bad) + ")"
        return (f"{verdict}: {sum(row.rays for row in good)} rays in {len(good)} rows, "
                f"largest range error {worst:.2e} ulp of float32, {known} known failures")


def verify(*, renderer: str = "auto", threads: int = 0) -> AccuracyReport:
    """Measures the accuracy of a renderer on this machine, as ``glidar verify`` does: every shape at
    every distance from 0.1 m to 10 km, and difficult cases, compared with closed forms.

    Args:
        renderer: "auto", "rays", "raster" or "gpu" ("opengl"). "raster" casts pinhole cameras only; rows
            without such beams are not applicable to it.
        threads: number of threads; 0: one per processor.

    Raises:
        Error: an unknown renderer or an invalid number of threads.
    """
    one_of(renderer, "renderer", ("auto", "rays", "raster", "gpu", "opengl"))
    names = AccuracyCase.__dataclass_fields__
    rows = _core.verify(renderer, whole(threads, "threads", 4096))
    return AccuracyReport(tuple(AccuracyCase(**{name: getattr(row, name) for name in names}) for row in rows))
