# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""From trial numbers to all values that a trial varies.

Everything is a function of (campaign seed, trial, purpose), and for Latin hypercubes also of the number of trials.
Hence any shard can be sampled independently.
"""

import warnings
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from glidar.campaign import philox

METHODS = ["random", "sobol", "latin_hypercube"]
SOBOL_BITS = 32
MAX_STRATA = 1 << 24  # maximum number of trials of a Latin hypercube; every process keeps their order in memory
TRIALS_PER_CHUNK = 1 << 18


@dataclass(frozen=True)
class Draws:
    """The samples of a quantity: uniform numbers and grid indices."""

    u: np.ndarray  # N x dims
    cell: np.ndarray  # N


def cells_of(quantities):
    """The number of cells of the combined grid of all quantities."""
    count = 1
    for _, distribution in quantities:
        count *= distribution.cells
    return count


def _sobol(seed, trials, names):
    """The Sobol sequence, each dimension with a random digital shift from the seed, which keeps it a digital net
    (L'Ecuyer and Lemieux, "Recent advances in randomized quasi-Monte Carlo methods", 2002)."""
    from scipy.stats import qmc

    dims = len(names)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # numbers of trials need not be powers of two
        engine = qmc.Sobol(dims, scramble=False, bits=SOBOL_BITS)
        if trials[0] > 0:
            engine.fast_forward(int(trials[0]))
        points = engine.random(len(trials))
    digits = np.round(points * 2.0**SOBOL_BITS).astype(np.uint64)
    for i, name in enumerate(names):
        digits[:, i] ^= np.uint64(philox.words(seed, [0], f"sobol shift {name}")[0, 0])
    return (digits.astype(np.float64) + 0.5) * 2.0**-SOBOL_BITS


@lru_cache(maxsize=1)  # all shards of a campaign use the same strata
def _strata(seed, total, names):
    """For each name (row) the stratum of each of `total` trials: a random permutation."""
    strata = np.empty((len(names), total), np.uint32)
    for row, name in zip(strata, names):
        keys = np.concatenate([
            philox.uniforms(seed, np.arange(first, min(first + TRIALS_PER_CHUNK, total)), f"stratum {name}", 1)[:, 0]
            for first in range(0, total, TRIALS_PER_CHUNK)])  # in chunks, because Philox needs 20 times the memory
        row[np.argsort(keys, kind="stable")] = np.arange(total, dtype=np.uint32)
    return strata


def _latin_hypercube(seed, trials, total, names):
    """Latin hypercube sampling: in every dimension, a random permutation assigns one of `total` equal strata to each
    trial (McKay, Beckman, Conover, Technometrics 21, 1979)."""
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
    """Samples of trials first .. first + count - 1, by purpose; `quantities` are pairs (purpose, distribution).
    Combined grids are enumerated repeatedly; the first quantity varies fastest."""
    trials = np.arange(first, first + count)
    names = [f"{purpose} {i}" for purpose, distribution in quantities for i in range(distribution.dims)]
    u = _uniforms(seed, trials, total, method, names)
    draws, cell, column = {}, trials % cells_of(quantities), 0
    for purpose, distribution in quantities:
        draws[purpose] = Draws(u[:, column : column + distribution.dims], cell % distribution.cells)
        column += distribution.dims
        cell = cell // distribution.cells
    return draws
