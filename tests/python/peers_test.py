# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""bench/peers.py: GLIDAR's hits and ranges agree with the known answers, and wrong ones would be found."""

import importlib.util
from pathlib import Path

import numpy as np

SOURCE = Path(__file__).resolve().parents[2] / "bench" / "peers.py"
SPEC = importlib.util.spec_from_file_location("peers", SOURCE)
peers = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(peers)

ROUNDINGS = 64 * np.finfo(float).eps  # of the ranges, divided by the cosine of the grazing scene (1.7e-4)
COUNT = 400


def scenes():
    return list(peers.scenes_of(np.random.default_rng(1), COUNT, []))


def test_glidar_has_no_wrong_hit_in_any_scene():
    for scene in scenes():
        wrong, error = peers.compare(scene, peers.Glidar(scene).cast())
        assert wrong == 0, scene.name
        extent = np.nanmax(scene.truth) + np.linalg.norm(scene.origin)
        assert error <= ROUNDINGS * extent * (6000 if "grazing" in scene.name else 1), (scene.name, error)


def test_every_scene_has_hits_and_most_rays_count():
    for scene in scenes():
        assert np.isfinite(scene.truth).mean() > 0.2, scene.name
        assert scene.counted.mean() > 0.9, scene.name


def test_wrong_hits_are_found():
    scene = scenes()[2]
    ranges = peers.Glidar(scene).cast().copy()
    hits, misses = np.flatnonzero(np.isfinite(ranges) & scene.counted), np.flatnonzero(np.isnan(ranges) & scene.counted)
    ranges[hits[0]] = np.nan
    ranges[hits[1]] *= 1.01
    ranges[misses[0]] = 5.0
    ranges[hits[2]] += 1e-4
    wrong, error = peers.compare(scene, ranges)
    assert wrong == 3
    assert 0.99e-4 < error < 1.01e-4


def test_points_of_a_moving_target_are_on_it_at_their_own_time():
    own_time, one_pose = peers.moving_target()
    assert own_time < 1e-12
    assert one_pose > 1.0


def test_signals_follow_the_range_equation_at_every_incidence():
    assert peers.signal_over_incidence() < 4 * np.finfo(np.float32).eps


def test_shares_at_an_edge_approach_those_of_a_gaussian_beam_with_more_sub_rays():
    errors = [peers.shares_at_an_edge(rings) for rings in (1, 3, 6)]
    assert errors[0] < 0.2  # half of the middle ray's share and of two others
    assert errors == sorted(errors, reverse=True)
    assert errors[2] < 0.03
