# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Fisher information of a frame about the sensor's pose."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._inputs import FloatArray, floats, path_of, whole
from ._state import Immutable, SameContent, key_of, part, restoring, make_state


@dataclass(frozen=True, eq=False)
class EigenDirection(SameContent):
    """One of six independent displacements: an eigenvector of the information matrix."""

    eigenvalue: float
    """Eigenvalue of the dimensionless information matrix, 1/m^2."""
    degenerate: bool
    """Whether the frame does not constrain this displacement."""
    displacement: FloatArray
    """(6,): rotation (rad) about x, y, z, then translation (m) along x, y, z, in the reference frame."""
    description: str
    """The displacement in words, such as "translation along x"."""


class FisherInformation(Immutable):
    """Fisher information about a pose from point-to-plane ranging, and the Cramer-Rao bounds.

    Displacements are six numbers in the reference frame: rotation (rad) about x, y, z, then translation (m)
    along x, y, z. ``str`` is a readable table. Can be compared, hashed, copied and pickled.
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
        return make_state("FisherInformation", parts=_core.information_state(self._core))

    def __setstate__(self, state: dict[str, Any]) -> None:
        with restoring("FisherInformation", state):
            self._core = _core.restore_information(part(state, "parts", dict))

    @property
    def matrix(self) -> FloatArray:
        """Fisher information matrix, (6, 6)."""
        return self._core.matrix

    @property
    def covariance(self) -> FloatArray:
        """Cramer-Rao bound, (6, 6): no unbiased estimate has a smaller covariance. Infinite on the diagonal for
        axes that take part in a degenerate direction."""
        return self._core.covariance

    @property
    def bound(self) -> FloatArray:
        """Standard deviations of the covariance, (6,): 3 in rad, 3 in m."""
        return self._core.bound

    @property
    def directions(self) -> tuple[EigenDirection, ...]:
        """Six independent displacements, from the best to the worst constrained."""
        return tuple(
            EigenDirection(d.eigenvalue, d.degenerate, d.displacement, d.words) for d in self._core.directions
        )

    @property
    def condition(self) -> float:
        """Ratio of the largest to the smallest eigenvalue; infinite when degenerate."""
        return self._core.condition

    @property
    def returns(self) -> int:
        """Number of returns that contributed."""
        return self._core.returns

    def to_dict(self) -> dict[str, Any]:
        """All values as plain numbers, with the convention; infinite values are None."""
        document: dict[str, Any] = json.loads(self._core.json())
        return document

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it as JSON, like ``glidar render --fisher``."""
        self._core.save(path_of(path, "path"))

    def __str__(self) -> str:
        return self._core.text()


def fisher_information_of(
    core: _core.Frame, sigma_m: float, reference: npt.ArrayLike | None, instance: int | None
) -> FisherInformation:
    """The information of a frame; see ``Frame.fisher_information``."""
    pose = floats(np.eye(4) if reference is None else reference, "reference", (4, 4))[None]
    sigma = float(floats(sigma_m, "sigma_m", ()))
    only = None if instance is None else whole(instance, "instance", len(core.world_from_objects) - 1)
    return FisherInformation(_core.fisher_information(core, sigma, pose, only))
