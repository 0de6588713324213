# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""From trial numbers to all that a trial varies.

Everything is a function of (campaign seed, trial, purpose), and for Latin hypercubes of how many trials
there are: any shard can be drawn by itself.
"""

import warnings
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from glidar.campaign import philox

METHODS = ["random", "sobol", "latin_hypercube"]
SOBOL_BITS = 32
MOST_STRATA = 1 << 24  # trials of a Latin hypercube, whose order every process keeps in memory
PIECE = 1 << 18  # trials whose keys are drawn together


@dataclass(frozen=True)
class Draws:
    """What a quantity is made of: uniform numbers, and its place in the grid."""

    u: np.ndarray  # N x dims
    cell: np.ndarray  # N


def cells_of(quantities):
    """How many trials the grids of all quantities take together."""
    count = 1
    for _, distribution in quantities:
        count *= distribution.cells
    return count


def _sobol(seed, trials, names):
    """Sobol's sequence, each dimension with a digital shift drawn from the seed, which keeps it a net
    (L'Ecuyer and Lemieux, "Recent advances in randomized quasi-Monte Carlo methods", 2002)."""
    from scipy.stats import qmc

    dims = len(names)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # runs that are no power of two are meant
        engine = qmc.Sobol(dims, scramble=False, bits=SOBOL_BITS)
        if trials[0] > 0:
            engine.fast_forward(int(trials[0]))
        points = engine.random(len(trials))
    digits = np.round(points * 2.0**SOBOL_BITS).astype(np.uint64)
    for i, name in enumerate(names):
        digits[:, i] ^= np.uint64(philox.words(seed, [0], f"sobol shift {name}")[0, 0])
    return (digits.astype(np.float64) + 0.5) * 2.0**-SOBOL_BITS


@lru_cache(maxsize=1)  # shard after shard of a campaign asks for the same
def _strata(seed, total, names):
    """For each name (row) the stratum of each of `total` trials: their places in a random order."""
    strata = np.empty((len(names), total), np.uint32)
    for row, name in zip(strata, names):
        keys = np.concatenate([
            philox.uniforms(seed, np.arange(first, min(first + PIECE, total)), f"stratum {name}", 1)[:, 0]
            for first in range(0, total, PIECE)])  # piece by piece, for Philox takes 20 times the memory
        row[np.argsort(keys, kind="stable")] = np.arange(total, dtype=np.uint32)
    return strata


def _latin_hypercube(seed, trials, total, names):
    """One of `total` equal strata for each trial in every dimension, by a random order of the trials
    (McKay, Beckman, Conover, Technometrics 21, 1979)."""
    u = np.empty((len(trials), len(names)))
    for i, (name, strata) in enumerate(zip(names, _strata(seed, total, tuple(names)))):
        within = philox.uniforms(seed, trials, name, 1)[:, 0]
        u[:, i] = (strata[trials] + within) / total
    return u


def _uniforms(seed, trials, total, method, names):
    if not names:
        return np.empty((len(trials), 0))
    if method == "sobol":
        return _sobol(seed, trials, names)
    if method == "latin_hypercube":
        return _latin_hypercube(seed, trials, total, names)
    return np.concatenate([philox.uniforms(seed, trials, name, 1) for name in names], axis=1)


def draw(seed, first, count, total, method, quantities):
    """The draws of trials first .. first + count - 1, by quantity; `quantities` are pairs (purpose,
    distribution). Grids run in the order of the quantities, the first the fastest, again and again."""
    trials = np.arange(first, first + count)
    names = [f"{purpose} {i}" for purpose, spread in quantities for i in range(spread.dims)]
    u = _uniforms(seed, trials, total, method, names)
    draws, cell, column = {}, trials % cells_of(quantities), 0
    for purpose, spread in quantities:
        draws[purpose] = Draws(u[:, column : column + spread.dims], cell % spread.cells)
        column += spread.dims
        cell = cell // spread.cells
    return draws
