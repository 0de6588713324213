# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The accuracy of hits, ids, ranges and normals on this machine."""

from __future__ import annotations

from dataclasses import dataclass

from . import _core
from ._inputs import one_of, whole


@dataclass(frozen=True)
class AccuracyCase:
    """One case with one shape at one distance (docs/accuracy.md)."""

    name: str
    """Of the case, such as "one shape at rest"."""
    shape: str
    distance_m: float
    rays: int
    judged_hits: int
    judged_misses: int
    near_edges: int
    """Not judged."""
    wrong_hits: int
    wrong_misses: int
    wrong_ids: int
    """Hits with another instance, or a triangle that does not hold the true point."""
    range_error_m: float
    """Largest."""
    range_error_ulp: float
    """Largest, in steps of float32 at the true range."""
    normal_error_rad: float
    """Largest."""
    known_failure: str
    """Why this renderer is known to fail here; empty: it has to pass."""
    verdict: str
    """"passed", "FAILED" (also by more than is known), "known failure", "FIXED" (it passes, though it
    is listed as a known failure), or "not applicable" (the renderer does not cast such beams)."""

    @property
    def passed(self) -> bool:
        """Within all bounds."""
        return self.verdict == "passed"


@dataclass(frozen=True)
class AccuracyReport:
    """What ``glidar.verify()`` found; true when every row passed, failed as known, or does not apply."""

    rows: tuple[AccuracyCase, ...]

    @property
    def passed(self) -> bool:
        """Ranges within 0.001 steps of float32, normals within 1e-6 rad, no wrong hit, miss or id, but
        for known failures, which are bounded too."""
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
    every distance from 0.1 m to 10 km, and the hard cases, compared with closed forms.

    renderer: "auto", "rays", "raster" or "opengl"; the last two cast pinhole cameras only, and rows
    without such beams do not apply to them. threads: 0: one per processor."""
    one_of(renderer, "renderer", ("auto", "rays", "raster", "opengl"))
    names = AccuracyCase.__dataclass_fields__
    rows = _core.verify(renderer, whole(threads, "threads", 4096))
    return AccuracyReport(tuple(AccuracyCase(**{name: getattr(row, name) for name in names}) for row in rows))
