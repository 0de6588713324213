# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Many measurements in one call."""

import threading
import time

import numpy as np
import pytest
from conftest import poses_around, same, two_spheres
from waiting import wait_until

import glidar


def test_frames_of_a_batch_are_bit_identical_to_single_measurements(asteroid, noisy):
    poses, seeds = poses_around(20), np.arange(7, 27)
    batch = glidar.simulate_batch(asteroid, noisy, poses, seeds)
    assert len(batch) == 20
    for k in (0, 7, 8, 19):
        assert same(batch[k], glidar.simulate(asteroid, noisy, poses[k], seed=7 + k))
        assert np.array_equal(batch[k].world_from_sensor, poses[k])


def test_noise_depends_on_seed_and_frame_number(asteroid, noisy):
    pose = poses_around(1)
    a, b, c, d = glidar.simulate_batch(asteroid, noisy, np.repeat(pose, 4, 0), [1, 1, 2, 1], frames=[0, 0, 0, 1])
    assert same(a, b)
    assert not same(a, c)
    assert not same(a, d)
    assert d.number == 1
    assert d.stamp_ns == round(1e9 / noisy.rate_hz)
    other = glidar.simulate(asteroid, noisy, pose[0], seed=1, sensor_id=1)
    assert not same(a, other)


def test_results_do_not_depend_on_the_number_of_threads(asteroid, noisy):
    pose = poses_around(1)[0]
    one = glidar.simulate(asteroid, noisy, pose, threads=1)
    assert same(one, glidar.simulate(asteroid, noisy, pose, threads=2))


def test_objects_can_have_different_poses_in_every_frame(camera):
    scene, objects, poses = two_spheres()
    frames = glidar.simulate_batch(scene, camera, poses, objects=objects)
    first, second, third = (f.ground_truth.instance for f in frames)
    assert np.array_equal(np.where(first < 2, 1 - first, first), second)
    assert set(np.unique(third[third < 2])) <= {0, 1}
    assert np.array_equal(frames[1].world_from_objects, objects[1])
    # the same for all frames, and one measurement alone
    for frame in glidar.simulate_batch(scene, camera, poses, objects=objects[1]):
        assert same(frame, frames[1])
    assert same(glidar.simulate(scene, camera, poses[0], objects=objects[0]), frames[0])


def test_frames_of_a_moving_sensor_differ_from_those_of_a_stationary_one(asteroid):
    lidar = glidar.load_sensor("VLP-16").ground_truth()
    pose = glidar.look_at([3, 0, 0], [0, 0, 0], boresight="x")
    still = glidar.simulate(asteroid, lidar, pose)
    spin = glidar.Trajectory.spin(np.eye(4), [0, 0, 3.0])
    moving = glidar.simulate(asteroid, lidar, pose, objects=[spin])
    assert still.hits > 0
    assert not same(still, moving)
    assert same(glidar.simulate_batch(asteroid, lidar, [pose, glidar.Trajectory.constant(pose)], objects=[spin])[1], moving)


def test_memory_of_existing_frames_is_not_reused(asteroid, camera):
    poses = poses_around(30)
    kept = glidar.simulate(asteroid, camera, poses[0]).range_m  # the frame itself is gone
    before = kept.copy()
    for _ in range(3):
        glidar.simulate_batch(asteroid, camera, poses)
    assert kept.tobytes() == before.tobytes()


def test_other_python_threads_run_during_a_batch(asteroid):
    sensor = glidar.camera(256, 256)
    spans, ticks = [], []

    def measure():
        start = time.perf_counter()
        glidar.simulate_batch(asteroid, sensor, poses_around(60))
        spans.append((start, time.perf_counter()))

    def python_ran_in_the_middle():
        """Where the call does not let go of the interpreter, only its beginning and its end are seen."""
        thread = threading.Thread(target=measure)
        thread.start()
        ticks.clear()
        while thread.is_alive():
            ticks.append(time.perf_counter())
            thread.join(0.001)
        start, end = spans.pop()
        return sum(start + (end - start) / 3 < t < end - (end - start) / 3 for t in ticks) > 1

    wait_until(python_ran_in_the_middle, "Python to run while a batch is measured")


def test_threads_can_measure_one_scene_concurrently(asteroid, noisy):
    poses = poses_around(16)
    expected = glidar.simulate_batch(asteroid, noisy, poses, np.arange(16))
    found = [None] * 16

    def work(k):
        found[k] = glidar.simulate(asteroid, noisy, poses[k], seed=k)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(16)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(same(a, b) for a, b in zip(expected, found, strict=True))


def test_gpu_renders_from_any_thread(asteroid, camera):
    try:
        first = glidar.simulate(asteroid, camera, renderer="gpu")
    except glidar.Error as error:
        pytest.skip(str(error))
    cast = glidar.simulate(asteroid, camera)
    assert abs(first.hits - cast.hits) <= 3
    found = []
    threads = [
        threading.Thread(target=lambda: found.append(glidar.simulate(asteroid, camera, renderer="gpu")))
        for _ in range(3)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 3
    assert all(same(first, other) for other in found)


def test_simulator_ignores_later_changes_of_the_scene(camera):
    scene = glidar.Scene("builtin:sphere")
    simulator = glidar.Simulator(scene, camera)
    pose = glidar.look_at([5, 0, 0], [0, 0, 0])
    before = simulator.simulate(pose)
    scene.objects[0].pose = glidar.pose([0, 100, 0])
    assert same(simulator.simulate(pose), before)
    assert glidar.simulate(scene, camera, pose).hits == 0


def test_empty_batches_and_wrong_sizes_are_rejected(asteroid, camera):
    poses = poses_around(3)
    for arguments, where in [
        ({"poses": np.empty((0, 4, 4))}, "pose"),
        ({"poses": poses[0][:3]}, "pose"),
        ({"poses": poses, "seeds": [1, 2]}, "seed"),
        ({"poses": poses, "seeds": [1.5, 2, 3]}, "seed"),
        ({"poses": poses, "seeds": -1}, "seed"),
        ({"poses": poses, "frames": [0, 1, 2**32]}, "frame"),
        ({"poses": poses, "objects": poses}, "objects"),
        ({"poses": poses, "objects": poses[None]}, "objects"),
        ({"poses": poses, "columns": ["xzy"]}, "cloud column"),
    ]:
        with pytest.raises(glidar.Error) as caught:
            glidar.simulate_batch(asteroid, camera, **arguments)
        assert caught.value.where == where, str(caught.value)
