# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What a frame can tell about the pose from which it was taken."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import Any

from . import _core
from ._inputs import FloatArray, path_of
from ._state import Immutable, SameContent, key_of, part, restoring, stated


@dataclass(frozen=True, eq=False)
class EigenDirection(SameContent):
    """One of six independent displacements."""

    eigenvalue: float
    """Of the dimensionless information, 1/m^2."""
    degenerate: bool
    """The frame does not determine it."""
    displacement: FloatArray
    """Rotation (rad) about x, y, z, then translation (m) along them, in the reference frame (6)."""
    words: str


class FisherInformation(Immutable):
    """Fisher's information about a pose by point-to-plane ranging, and the bounds that follow.

    Displacements are six numbers, in the reference frame: rotation (rad) about x, y, z, then
    translation (m) along x, y, z. ``str`` is a table for people. Can be compared, hashed, copied and
    pickled.
    """

    __slots__ = ("_core",)

    def __init__(self, core: _core.FisherInformation) -> None:
        self._core = core

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, FisherInformation):
            return NotImplemented
        return key_of(_core.information_state(self._core)) == key_of(_core.information_state(other._core))

    def __hash__(self) -> int:
        return hash(key_of(_core.information_state(self._core)))

    def __getstate__(self) -> dict[str, Any]:
        return stated("FisherInformation", parts=_core.information_state(self._core))

    def __setstate__(self, state: dict[str, Any]) -> None:
        with restoring("FisherInformation", state):
            self._core = _core.restore_information(part(state, "parts", dict))

    @property
    def matrix(self) -> FloatArray:
        """Fisher's information, (6, 6)."""
        return self._core.matrix

    @property
    def covariance(self) -> FloatArray:
        """Cramer-Rao: no unbiased estimate has a smaller one, (6, 6). Infinite on the diagonal for
        axes that take part in a degenerate direction."""
        return self._core.covariance

    @property
    def bound(self) -> FloatArray:
        """Its standard deviations: rad x3, m x3."""
        return self._core.bound

    @property
    def directions(self) -> tuple[EigenDirection, ...]:
        """Six independent displacements, from best to worst determined."""
        return tuple(
            EigenDirection(d.eigenvalue, d.degenerate, d.displacement, d.words) for d in self._core.directions
        )

    @property
    def condition(self) -> float:
        """Best over worst eigenvalue; infinite when degenerate."""
        return self._core.condition

    @property
    def returns(self) -> int:
        """Returns that counted."""
        return self._core.returns

    def to_dict(self) -> dict[str, Any]:
        """All of it as plain numbers, with the convention; what is infinite is None."""
        told: dict[str, Any] = json.loads(self._core.json())
        return told

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it as JSON, as ``glidar render --fisher`` does."""
        self._core.save(path_of(path, "path"))

    def __str__(self) -> str:
        return self._core.text()
