# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Workers of other libraries receive scenes and sensors, and return frames."""

import multiprocessing

import numpy as np
import pytest

import glidar


def measured_elsewhere(scene, sensor, pose, seed):
    return glidar.simulate(scene, sensor, pose, seed=seed)


def test_multiprocessing_workers_accept_scenes_and_return_frames(built, noisy):
    pose = glidar.look_at([6, 3, 2], [0, 0, 0])
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        frames = pool.starmap(measured_elsewhere, [(built, noisy, pose, seed) for seed in (1, 2)])
    for seed, frame in zip((1, 2), frames, strict=True):
        expected = glidar.simulate(built, noisy, pose, seed=seed)
        assert frame == expected
        assert frame.cloud() == expected.cloud()


def test_joblib_workers_accept_scenes_and_return_frames(built, noisy):
    joblib = pytest.importorskip("joblib")
    pose = glidar.look_at([6, 3, 2], [0, 0, 0])
    job = joblib.delayed(measured_elsewhere)
    frames = joblib.Parallel(n_jobs=2, backend="loky")(job(built, noisy, pose, seed) for seed in (1, 2))
    assert frames == [glidar.simulate(built, noisy, pose, seed=seed) for seed in (1, 2)]


def test_dask_workers_accept_scenes_and_return_frames(built, noisy):
    distributed = pytest.importorskip("distributed")
    pose = glidar.look_at([6, 3, 2], [0, 0, 0])
    options = {"n_workers": 1, "threads_per_worker": 1, "processes": True, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        (held,) = client.scatter([built])
        frame = client.submit(glidar.simulate, held, noisy, pose, seed=3).result()
    assert frame == glidar.simulate(built, noisy, pose, seed=3)


class Views:
    """A data set as PyTorch's DataLoader wants one: it pickles it to its workers, which index it."""

    def __init__(self, scene, sensor, poses):
        self.scene, self.sensor, self.poses = scene, sensor, poses

    def __len__(self):
        return len(self.poses)

    def __getitem__(self, index):
        frame = glidar.simulate(self.scene, self.sensor, self.poses[index], seed=index)
        return np.array(frame.range_m), np.array(frame.intensity)


def item_of(views, index):
    return views[index]


def test_a_data_set_can_be_sent_to_a_spawned_data_loader_worker(built, noisy):
    views = Views(built, noisy, np.stack([glidar.look_at([6, k, 2], [0, 0, 0]) for k in range(3)]))
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        items = pool.starmap(item_of, [(views, index) for index in range(len(views))])
    for index, (ranges, intensity) in enumerate(items):
        assert ranges.tobytes() == views[index][0].tobytes()
        assert intensity.tobytes() == views[index][1].tobytes()
