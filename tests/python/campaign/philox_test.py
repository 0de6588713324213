# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Random numbers of campaigns: published test vectors, and dependence on (seed, trial, purpose) only."""

import numpy as np
import pytest
from scipy import stats

from glidar.campaign import philox

# Random123's kat_vectors, philox4x32 with 10 rounds: counter, key, answer.
KNOWN = [
    ([0] * 4, [0] * 2, [0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8]),
    ([0xFFFFFFFF] * 4, [0xFFFFFFFF] * 2, [0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD]),
    ([0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344], [0xA4093822, 0x299F31D0],
     [0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1]),
]


@pytest.mark.parametrize("counter, key, answer", KNOWN)
def test_philox_gives_the_published_test_vectors(counter, key, answer):
    assert philox.philox4x32(np.array([counter]), key)[0].tolist() == answer


def test_random_numbers_of_a_trial_do_not_depend_on_the_run():
    all_trials = philox.uniforms(7, np.arange(1000), "pose 0", 3)
    assert np.array_equal(all_trials[400:500], philox.uniforms(7, np.arange(400, 500), "pose 0", 3))


def test_random_numbers_differ_between_seeds_trials_purposes_and_blocks():
    base = philox.words(7, [5], "a")
    for other in (philox.words(8, [5], "a"), philox.words(7, [6], "a"), philox.words(7, [5], "b"),
                  philox.words(7, [5], "a", 1), philox.words(7 + (1 << 32), [5], "a"),
                  philox.words(7, [5 + (1 << 32)], "a")):
        assert not np.array_equal(base, other)


def test_uniforms_are_uniform_and_strictly_between_0_and_1():
    u = philox.uniforms(1, np.arange(200_000), "x", 3)
    assert 0.0 < u.min() and u.max() < 1.0
    for column in u.T:
        assert stats.kstest(column, "uniform").pvalue > 1e-3
    assert np.abs(np.corrcoef(u.T) - np.eye(3)).max() < 0.01


def test_frame_seeds_are_all_different():
    assert len(np.unique(philox.seeds(3, np.arange(100_000)))) == 100_000
