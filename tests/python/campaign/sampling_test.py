# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Sampling methods: samples do not depend on shards; strata and grids are complete."""

import numpy as np
import pytest
from scipy.stats import qmc

from glidar.campaign import philox, sampling
from glidar.campaign.distributions import Constant, Grid, Uniform

QUANTITIES = [("a", Uniform(0, 1)), ("fixed", Constant(3.0)), ("b", Uniform(0, 1)),
              ("c", Uniform(0, 1))]


def points(method, first, count, total=1024, seed=5):
    draws = sampling.draw(seed, first, count, total, method, QUANTITIES)
    return np.concatenate([draws[name].u for name in "abc"], axis=1)


@pytest.mark.parametrize("method", sampling.METHODS)
def test_samples_of_a_shard_do_not_depend_on_other_shards(method):
    whole = points(method, 0, 1024)
    for first, count in ((0, 1), (1, 100), (700, 324), (1023, 1)):
        assert np.array_equal(points(method, first, count), whole[first : first + count])


@pytest.mark.parametrize("method", sampling.METHODS)
def test_samples_are_within_0_and_1_and_depend_on_the_seed(method):
    whole = points(method, 0, 1024)
    assert whole.min() > 0.0 and whole.max() < 1.0
    assert not np.array_equal(whole, points(method, 0, 1024, seed=6))


def test_a_latin_hypercube_has_one_trial_in_every_stratum():
    strata = np.sort(np.floor(1000 * points("latin_hypercube", 0, 1000, 1000)), axis=0)
    assert np.array_equal(strata, np.tile(np.arange(1000.0)[:, None], (1, 3)))


def test_a_latin_hypercube_computes_its_permutation_once(monkeypatch):
    whole = points("latin_hypercube", 0, 1000, 1000, seed=9)
    order = np.argsort(np.argsort(philox.uniforms(9, np.arange(1000), "stratum a 0", 1)[:, 0]))
    assert np.array_equal(np.floor(1000 * whole[:, 0]), order)
    monkeypatch.setattr(sampling, "TRIALS_PER_CHUNK", 300)
    drawn = sampling._strata.cache_info().misses
    points("latin_hypercube", 0, 1000, 1000, seed=8)
    shards = [points("latin_hypercube", first, 250, 1000, seed=9) for first in range(0, 1000, 250)]
    assert np.array_equal(np.concatenate(shards), whole)
    assert sampling._strata.cache_info().misses == drawn + 2


def test_sobol_points_fill_every_elementary_interval():
    sobol = points("sobol", 0, 1024)
    for column in sobol.T:
        assert np.array_equal(np.bincount((column * 1024).astype(int)), np.ones(1024))
    cells = (sobol[:, 0] * 32).astype(int) * 32 + (sobol[:, 1] * 32).astype(int)
    assert np.array_equal(np.bincount(cells), np.ones(1024))  # a (0, 10, 2) net
    assert qmc.discrepancy(sobol) < 0.1 * qmc.discrepancy(points("random", 0, 1024))


def test_grids_enumerate_all_cells_repeatedly():
    quantities = [("x", Grid((1.0, 2.0))), ("u", Uniform(0, 1)), ("y", Grid((10.0, 20.0, 30.0)))]
    draws = sampling.draw(0, 0, 8, 8, "random", quantities)
    x = quantities[0][1].sample(draws["x"].u, draws["x"].cell)
    y = quantities[2][1].sample(draws["y"].u, draws["y"].cell)
    assert sampling.cells_of(quantities) == 6
    assert list(zip(x, y)) == [(1, 10), (2, 10), (1, 20), (2, 20), (1, 30), (2, 30), (1, 10), (2, 10)]
