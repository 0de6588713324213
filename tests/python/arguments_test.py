# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Arguments that are not arrays or have another type."""

import numpy as np
import pytest
from conftest import poses_around

import glidar

RAGGED = [1, [2, 3]]


@pytest.mark.parametrize(
    ("call", "where"),
    [
        (lambda s, c, p: glidar.simulate_batch(s, c, p, RAGGED), "seed: not an array"),
        (lambda s, c, p: glidar.simulate_batch(s, c, p, frames=RAGGED), "frame: not an array"),
        (lambda s, c, p: list(glidar.simulate_iter(s, c, p, RAGGED)), "seeds[1]: [2, 3]"),
        (lambda s, c, p: list(glidar.simulate_iter(s, c, p, frames=RAGGED)), "frames[1]: [2, 3]"),
        (lambda s, c, p: glidar.simulate_batch(s, c, [[[1], [2, 3]]]), "pose: not an array"),
        (lambda s, c, p: list(glidar.simulate_iter(s, c, [[[1], [2, 3]]])), "poses[0]: not an array"),
        (lambda s, c, p: glidar.simulate(s, c, [[1], [2, 3]]), "pose: not an array"),
        (lambda s, c, p: glidar.simulate(s, c, p[0], objects=[[1], [2, 3]]), "objects: not an array"),
        (lambda s, c, p: glidar.simulate_batch(s, c, p, objects=[[1], [2, 3]]), "objects: not an array"),
        (lambda s, c, p: list(glidar.simulate_iter(s, c, p, objects=[[1], [2, 3]])), "objects: not an array"),
        (lambda s, c, p: glidar.simulate(s, c, p[0]).bird_eye(size=RAGGED), "picture_size: not an array"),
        (lambda s, c, p: glidar.simulate(s, c, p[0], seed=True), "seed: True; allowed: a whole number"),
        (lambda s, c, p: glidar.sensor("VLP-16", returns=True), "returns: True; allowed"),
        (lambda s, c, p: glidar.sensor("VLP-16", columns_per_turn=True), "columns_per_turn: True; allowed"),
    ],
)
def test_ragged_arrays_and_non_numbers_raise_an_error(asteroid, camera, call, where):
    with pytest.raises(glidar.Error) as error:
        call(asteroid, camera, poses_around(2))
    assert str(error.value).startswith(where), error.value


def frames_both_ways(scene, sensor, poses, **options):
    return list(glidar.simulate_iter(scene, sensor, poses, **options)), glidar.simulate_batch(scene, sensor, poses, **options)


def test_simulate_iter_accepts_the_arguments_of_simulate_batch(camera):
    scene = glidar.Scene()
    scene.add_model("builtin:sphere", name="a")
    scene.add_instance(scene["a"], name="b")
    left, right = glidar.pose([-1, 0, 0]), glidar.pose([1, 0, 0])
    pose = glidar.look_at([0, -8, 0], [0, 0, 0])
    lists = [[left, right], [right, left], [left.tolist(), left]]
    for poses, objects in (
        ([pose] * 3, lists),
        ([pose] * 3, np.array(lists)),
        ([pose] * 3, [left, right]),
        (pose, [[right, left]]),
        (pose.tolist(), None),
        (glidar.Trajectory.constant(pose), None),
        ([pose] * 4, None),
    ):
        one, other = frames_both_ways(scene, camera, poses, objects=objects)
        assert one == other
        assert one[0].hits > 0


def test_poses_of_objects_are_required_for_every_frame(camera, asteroid):
    objects = np.stack([np.eye(4)[None]] * 2)
    with pytest.raises(glidar.Error, match="objects: 2 for 3 poses; allowed: poses for each frame"):
        glidar.simulate_iter(asteroid, camera, poses_around(3), objects=objects)
