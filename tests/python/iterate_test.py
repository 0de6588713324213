# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""simulate_iter: one frame after the other for any number of poses."""

import gc
import tracemalloc
from itertools import count, islice

import numpy as np
import pytest
from conftest import poses_around, same, two_spheres

import glidar

PIXEL = glidar.camera(2, 2, fov_deg=20.0, noise=[{"type": "range_gaussian", "sigma_m": 0.01}])


def poses_without_end():
    for k in count():
        yield glidar.look_at([4.0, 0.001 * (k % 100), 0.0], [0, 0, 0])


@pytest.mark.parametrize("batch", [1, 3, 8, 100])
def test_frames_are_bit_identical_to_those_of_a_batch(asteroid, noisy, batch):
    poses, seeds, numbers = poses_around(20), np.arange(7, 27), np.arange(100, 120)
    expected = glidar.simulate_batch(asteroid, noisy, poses, seeds, frames=numbers, sensor_id=3)
    frames = glidar.simulate_iter(
        asteroid, noisy, iter(poses), iter(seeds), frames=(n for n in numbers), sensor_id=3, batch=batch
    )
    assert list(frames) == expected
    assert list(glidar.simulate_iter(asteroid, noisy, poses)) == glidar.simulate_batch(asteroid, noisy, poses)
    assert list(glidar.simulate_iter(asteroid, noisy, poses, 5)) == glidar.simulate_batch(asteroid, noisy, poses, 5)


def test_noise_differs_between_frames_without_seeds(asteroid, noisy):
    poses = np.repeat(poses_around(1), 10, 0)
    frames = glidar.simulate_batch(asteroid, noisy, poses)
    assert [frame.seed for frame in frames] == list(range(1, 11))
    assert len({frame.range_m.tobytes() for frame in frames}) == 10
    assert same(frames[3], glidar.simulate(asteroid, noisy, poses[0], seed=4))
    one_for_all = glidar.simulate_batch(asteroid, noisy, poses, 1)
    assert len({frame.range_m.tobytes() for frame in one_for_all}) == 1


def test_poses_of_objects_are_common_or_per_frame(camera):
    scene, objects, poses = two_spheres()
    left, right = objects[0]
    expected = glidar.simulate_batch(scene, camera, poses, objects=objects)
    assert list(glidar.simulate_iter(scene, camera, poses, objects=objects)) == expected
    assert list(glidar.simulate_iter(scene, camera, poses, objects=iter(objects))) == expected
    spin = glidar.Trajectory.spin(left, [0, 0, 1])
    assert list(glidar.simulate_iter(scene, camera, poses, objects=[spin, right])) == glidar.simulate_batch(
        scene, camera, poses, objects=[spin, right]
    )


def test_poses_are_read_lazily(asteroid):
    taken = 0

    def poses():
        nonlocal taken
        for pose in poses_without_end():
            taken += 1
            yield pose

    frames = glidar.simulate_iter(asteroid, PIXEL, poses(), batch=4)
    assert taken == 0
    for index, _ in enumerate(islice(frames, 100)):
        assert index < taken <= index + 4


def test_memory_does_not_grow_with_the_number_of_frames(asteroid):
    frames = glidar.simulate_iter(asteroid, PIXEL, poses_without_end())
    for _ in islice(frames, 200):
        pass
    gc.collect()
    tracemalloc.start()
    try:
        start = tracemalloc.get_traced_memory()[0]
        for _ in islice(frames, 5000):
            pass
        gc.collect()
        grown = tracemalloc.get_traced_memory()[0] - start
    finally:
        tracemalloc.stop()
    # 5000 stored frames would be at least 5000 Python objects of at least 48 bytes
    assert grown < 50_000


def resident_kib():
    with open("/proc/self/status", encoding="ascii") as status:
        return int(next(line for line in status if line.startswith("VmRSS")).split()[1])


def test_memory_of_the_process_does_not_grow_with_the_number_of_frames(asteroid):
    sensor = glidar.camera(64, 64, fov_deg=20.0)
    frames = glidar.simulate_iter(asteroid, sensor, poses_without_end())
    for _ in islice(frames, 100):
        pass
    before = resident_kib()
    for _ in islice(frames, 2000):
        pass
    # stored frames would need at least 2000 x 4096 beams x 60 bytes, or 480 MB
    assert resident_kib() - before < 48_000


def test_iteration_can_be_interrupted_and_resumed(asteroid, noisy):
    poses = poses_around(20)
    expected = glidar.simulate_batch(asteroid, noisy, poses)
    frames = glidar.simulate_iter(asteroid, noisy, poses)
    assert list(islice(frames, 5)) == expected[:5]
    assert next(frames) == expected[5]
    frames.close()
    with pytest.raises(StopIteration):
        next(frames)
    assert glidar.simulate(asteroid, noisy, poses[7], seed=8) == expected[7]


def test_a_pose_can_depend_on_the_previous_frame():
    sphere = glidar.Scene("builtin:sphere")
    seen = []

    def poses():
        distance = 6.0
        for _ in range(5):
            yield glidar.look_at([distance, 0, 0], [0, 0, 0])
            distance = float(np.nanmin(seen[-1].range_m)) + 3.0

    for frame in glidar.simulate_iter(sphere, glidar.camera(9, 9, fov_deg=5.0), poses(), batch=1):
        seen.append(frame)
    assert len(seen) == 5


def first_frames_and_error(frames):
    found = []
    with pytest.raises(glidar.Error) as error:
        for frame in frames:
            found.append(frame)
    return found, str(error.value)


@pytest.mark.parametrize("batch", [1, 4, 100])
def test_an_error_names_its_frame_and_is_raised_after_the_frames_before_it(asteroid, noisy, batch):
    poses = list(poses_around(9))
    expected = glidar.simulate_batch(asteroid, noisy, np.stack(poses))
    wrong = [*poses[:6], np.zeros((4, 4)), *poses[7:]]
    for given, options, message in [
        (wrong, {}, "poses[6]"),
        ([*poses[:6], np.eye(3), *poses[7:]], {}, "poses[6]: an array 3 x 3"),
        ([*poses[:6], "pose"], {}, "poses[6]"),
        (poses, {"seeds": iter([1, 2, 3, 4, 5, 6])}, "seeds[6]: there is none"),
        (poses, {"seeds": iter([1, 2, 3, 4, 5, 6, -1])}, "seeds[6]: -1"),
        (poses, {"frames": iter([0, 0, 0, 0, 0, 0, 2.5])}, "frames[6]: 2.5"),
        (poses, {"objects": iter([np.eye(4)[None]] * 6)}, "objects[6]: there is none"),
        (poses, {"objects": iter([np.eye(4)[None]] * 6 + [np.stack([np.eye(4)] * 2)])}, "objects[6]: 2 poses"),
    ]:
        found, text = first_frames_and_error(glidar.simulate_iter(asteroid, noisy, given, **options, batch=batch))
        assert text.startswith(message), text
        assert len(found) == 6
        assert all(same(one, other) for one, other in zip(found, expected[:6], strict=True))


def test_an_exception_of_the_callers_generator_is_passed_on(asteroid):
    def poses():
        yield from islice(poses_without_end(), 5)
        raise RuntimeError("no more")

    frames = glidar.simulate_iter(asteroid, PIXEL, poses())
    assert len(list(islice(frames, 5))) == 5
    with pytest.raises(RuntimeError, match="no more"):
        next(frames)


def test_invalid_arguments_raise_before_the_first_frame(asteroid, camera):
    poses = poses_around(3)
    for arguments, options, message in [
        ((7,), {}, "poses: a int; allowed: an array N x 4 x 4, a list or a generator"),
        ((poses, [1, 2]), {}, "seeds: 2 for 3 poses"),
        ((poses,), {"frames": [1, 2, 3, 4]}, "frames: 4 for 3 poses"),
        ((poses, -1), {}, "seeds: -1"),
        ((poses,), {"batch": 0}, "batch: 0; allowed: a whole number from 1"),
        ((poses,), {"objects": [np.eye(4)] * 3}, "objects: 3 poses"),
        ((poses,), {"columns": ["xyzz"]}, "xyzz"),
    ]:
        with pytest.raises(glidar.Error) as error:
            glidar.simulate_iter(asteroid, camera, *arguments, **options)
        assert message in str(error.value)
    assert list(glidar.simulate_iter(asteroid, camera, [])) == []
