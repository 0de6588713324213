# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Poses and trajectories."""

import numpy as np
import pytest

import glidar

HALF = np.sqrt(0.5)


@pytest.mark.parametrize("length", [1e200, 1e-155, 5e-324, 1.7e308])
def test_quaternions_are_normalised(length):
    turned = glidar.pose(wxyz=[length, length, 0, 0])
    assert turned[:3, :3] == pytest.approx(np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]), abs=1e-15)


def test_quaternions_are_named_by_their_order():
    turned = glidar.pose([1, 2, 3], wxyz=[HALF, 0, 0, HALF])
    assert turned[:3, :3] == pytest.approx(np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]]), abs=1e-15)
    assert turned[:3, 3].tolist() == [1, 2, 3]
    assert np.array_equal(turned, glidar.pose([1, 2, 3], xyzw=[0, 0, 2 * HALF, 2 * HALF]))
    assert np.array_equal(glidar.pose(matrix=turned[:3, :3])[:3, :3], turned[:3, :3])
    assert glidar.quaternion(turned, "wxyz") == pytest.approx([HALF, 0, 0, HALF])
    assert glidar.quaternion(turned[:3, :3], "xyzw") == pytest.approx([0, 0, HALF, HALF])
    assert np.array_equal(glidar.pose(), np.eye(4))


def test_look_at_puts_the_target_on_the_boresight():
    eye, target = np.array([3.0, -2.0, 5.0]), np.array([1.0, 1.0, 0.0])
    for boresight in "xz":
        pose = glidar.look_at(eye, target, boresight=boresight)
        ahead = np.linalg.inv(pose) @ [*target, 1.0]
        distance = np.linalg.norm(target - eye)
        assert ahead[:3] == pytest.approx([distance, 0, 0] if boresight == "x" else [0, 0, distance], abs=1e-12)


def test_look_at_straight_down_has_world_x_up_in_the_image():
    camera = glidar.look_at([1, 2, 5], [1, 2, 0])
    assert np.array_equal(camera[:3, :3], np.array([[0, -1, 0], [-1, 0, 0], [0, 0, -1]]))
    lidar = glidar.look_at([1, 2, 5], [1, 2, 0], boresight="x")
    assert np.array_equal(lidar[:3, 0], [0, 0, -1])
    assert np.array_equal(lidar[:3, 2], [1, 0, 0])


def test_single_precision_poses_are_orthonormalised(asteroid, camera):
    pose = glidar.look_at([4, 4, 3], [0, 0, 0])
    frame = glidar.simulate(asteroid, camera, pose.astype(np.float32))
    rotation = frame.world_from_sensor[:3, :3]
    assert rotation @ rotation.T == pytest.approx(np.eye(3), abs=1e-15)
    assert rotation == pytest.approx(pose[:3, :3], abs=1e-6)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: glidar.pose([1, 2]), "xyz: an array 2; allowed: an array 3"),
        (lambda: glidar.pose([1, 2, np.inf]), "xyz: inf at [2]"),
        (lambda: glidar.pose(wxyz=[1, 0, 0, 0], xyzw=[0, 0, 0, 1]), "wxyz and xyzw are given; allowed: one rotation"),
        (lambda: glidar.pose(wxyz=[0, 0, 0, 0]), "the quaternion is zero"),
        (lambda: glidar.pose(matrix=2 * np.eye(3)), "no rigid transform"),
        (lambda: glidar.pose(matrix=-np.eye(3)), "no rigid transform"),
        (lambda: glidar.look_at([0, 0, 0], [0, 0, 0]), "same point"),
        (lambda: glidar.look_at([0, 0, 5], [0, 0, 0], [0, 0, 1]), "parallel"),
        (lambda: glidar.look_at([0, 0, 5], [0, 0, 0], boresight="y"), "boresight: 'y'"),
        (lambda: glidar.quaternion(np.eye(4), "zyxw"), "order: 'zyxw'"),
        (lambda: glidar.quaternion(3 * np.eye(3), "wxyz"), "matrix"),
        (lambda: glidar.quaternion(np.diag([1, 1, -1]), "wxyz"), "matrix"),
        (lambda: glidar.quaternion([[1, 0], [0]], "wxyz"), "matrix: not an array"),
        (lambda: glidar.pose("here"), "xyz: an array of <U4"),
        (lambda: glidar.pose([[1], [2, 3]]), "xyz: not an array"),
        (lambda: glidar.Trajectory.timed([0, 0], np.stack([np.eye(4)] * 2)), "increas"),
        (lambda: glidar.Trajectory.timed([0, 1], np.eye(4)[None]), "poses: an array 1 x 4 x 4; allowed: an array 2 x 4 x 4"),
        (lambda: glidar.Trajectory.timed([], np.empty((0, 4, 4))), "times_s: an array 0; allowed: an array n"),
        (lambda: glidar.Trajectory.spin(np.eye(4), [0, 0, np.nan]), "rate_rad_s: nan at [2]"),
        (lambda: glidar.Trajectory.spin(np.eye(4), [0, 0, 1], t0_s=1e10), "t0_s"),
        (lambda: glidar.Trajectory.tumbling(np.eye(4), [1, 1, 9], [1, 0, 0]), "moment"),
        (lambda: glidar.Trajectory.load("nowhere.tum"), "nowhere.tum"),
    ],
)
def test_invalid_poses_raise_an_error(make, words):
    with pytest.raises(glidar.Error) as caught:
        make()
    assert words in str(caught.value)


def test_spin_rotates_about_the_bodys_axis():
    spin = glidar.Trajectory.spin(glidar.pose([1, 0, 0]), [0, 0, np.pi / 2], t0_s=1.0)
    assert spin.pose_at(2.0) == pytest.approx(glidar.pose([1, 0, 0], wxyz=[HALF, 0, 0, HALF]), abs=1e-15)
    assert np.array_equal(spin.pose_at(1.0), glidar.pose([1, 0, 0]))
    assert spin.known_s[1] > 9e9


def test_twist_is_a_screw_motion():
    twist = glidar.Trajectory.twist(np.eye(4), [0, 0, np.pi / 2], [0, 0, 3.0])
    assert twist.pose_at(1.0) == pytest.approx(glidar.pose([0, 0, 3], wxyz=[HALF, 0, 0, HALF]), abs=1e-14)
    in_world = glidar.Trajectory.twist(glidar.pose([1, 0, 0]), [0, 0, np.pi], in_world=True)
    assert in_world.pose_at(1.0)[:3, 3] == pytest.approx([-1, 0, 0], abs=1e-14)


def test_timed_poses_are_interpolated_linearly_and_held_outside():
    poses = np.stack([glidar.pose(), glidar.pose([2, 0, 0], wxyz=[HALF, 0, 0, HALF])])
    timed = glidar.Trajectory.timed([1.0, 3.0], poses)
    assert timed.known_s == (1.0, 3.0)
    between = timed.poses_at([0.0, 1.0, 2.0, 3.0, 9.0])
    assert between[:, 0, 3] == pytest.approx([0, 0, 1, 2, 2])
    assert np.arctan2(between[2, 1, 0], between[2, 0, 0]) == pytest.approx(np.pi / 4)


def test_tumbling_conserves_angular_momentum():
    moments, rate = np.array([1.0, 2.0, 2.5]), np.array([0.3, 1.0, 0.2])
    tumbling = glidar.Trajectory.tumbling(np.eye(4), moments, rate)
    h = 1e-5
    for t in (0.0, 3.7, 250.0):
        before, now, after = (tumbling.pose_at(t + d)[:3, :3] for d in (-h, 0.0, h))
        skew = now.T @ (after - before) / (2 * h)
        omega = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
        assert now @ (moments * omega) == pytest.approx(moments * rate, abs=1e-5)


def test_pose_files_are_read(tmp_path):
    (tmp_path / "a.tum").write_text("0 1 2 3 0 0 0 1\n1 2 2 3 0 0 0 1\n")
    assert glidar.Trajectory.load(tmp_path / "a.tum").pose_at(0.5)[:3, 3].tolist() == [1.5, 2, 3]
    (tmp_path / "k.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 4 0 1 0 0 0 0 1 0\n")
    assert glidar.Trajectory.load(tmp_path / "k.txt", rate_hz=2.0).pose_at(0.25)[0, 3] == 2.0
    assert glidar.Trajectory.load(tmp_path / "a.tum", start_s=5.0).known_s == (5.0, 6.0)
    with pytest.raises(glidar.Error):
        glidar.Trajectory.load(tmp_path / "k.txt")


def test_deskew_corrects_the_motion_distortion_of_a_cloud():
    lidar = glidar.load_sensor("VLP-16").ground_truth()
    scene = glidar.Scene("builtin:box")
    moving = glidar.Trajectory.twist(np.eye(4), [0, 0, 1.0], [0.5, 0, 0])
    frame = glidar.simulate(scene, lidar, moving, columns="all")
    skewed = frame.cloud(["xyz"], drop_invalid=True)["xyz"]
    straight = frame.cloud(["xyz"], drop_invalid=True, deskew=True)["xyz"]
    walls = np.abs(straight).max(axis=1)
    assert walls == pytest.approx(np.ones(len(walls)), abs=1e-6)
    assert np.abs(np.abs(skewed).max(axis=1) - 1).max() > 0.01
    assert frame.cloud(["sensor_pose"])["sensor_pose"].shape[-1] == 7
