# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Stamps of frames, IMUs and data sets, on trajectories with and without dates."""

import json

import numpy as np
import pytest

import glidar
from glidar.nuscenes import NuscenesWriter

SECOND = 10**9
RECORDED = 1_700_000_000_123_456_789
ROOM = "builtin:box:size=20,16,6"


def drive(first_ns, **options):
    """Along x by 1 m/s for four seconds."""
    times_ns = first_ns + SECOND * np.arange(5)
    return glidar.Trajectory.timed(None, [glidar.pose([k, 0, 0]) for k in range(5)], times_ns=times_ns, **options)


@pytest.fixture(scope="module")
def simulator():
    return glidar.Simulator(glidar.Scene(ROOM), glidar.sensor("VLP-16").ground_truth())


def test_a_frame_has_the_time_of_its_trajectory(simulator):
    for first_ns in (RECORDED, 5 * SECOND, 0):
        frame = simulator.simulate(drive(first_ns), frame=10, columns="xyz,stamp,time")
        assert frame.stamp_ns == first_ns + SECOND
        assert frame.world_from_sensor[:3, 3] == pytest.approx([1, 0, 0], abs=1e-12)
        cloud = frame.cloud("stamp,time")
        assert np.array_equal(cloud["stamp"], frame.stamp_ns + cloud["time"].astype(np.int64))


def test_ranges_are_the_same_bits_at_any_start(simulator):
    wanted = simulator.simulate(drive(0), frame=3).cloud("range")["range"].tobytes()
    assert simulator.simulate(drive(RECORDED), frame=3).cloud("range")["range"].tobytes() == wanted
    moved = simulator.simulate(drive(5 * SECOND), frame=3, start_ns=RECORDED)
    assert moved.cloud("range")["range"].tobytes() == wanted
    assert moved.stamp_ns == RECORDED + 3 * SECOND // 10


def test_a_start_time_is_looked_up_on_a_trajectory_with_dates(simulator):
    frame = simulator.simulate(drive(RECORDED), start_ns=RECORDED + 2 * SECOND)
    assert frame.stamp_ns == RECORDED + 2 * SECOND
    assert frame.world_from_sensor[:3, 3] == pytest.approx([2, 0, 0], abs=1e-12)
    with pytest.raises(glidar.Error, match="outside of the trajectory of the sensor"):
        simulator.simulate(drive(RECORDED), start_ns=RECORDED - 1)
    with pytest.raises(glidar.Error, match="start_ns"):
        simulator.simulate(start_ns=-1)


def test_all_calls_take_a_start(simulator):
    start = {"start_ns": RECORDED}
    poses = [glidar.pose(), glidar.pose([1, 0, 0])]
    assert simulator.simulate(poses[0], **start).stamp_ns == RECORDED
    frames = [*simulator.simulate_batch(poses, frames=[0, 1], **start),
              *simulator.simulate_iter(poses, frames=[0, 1], **start)]  # fmt: skip
    assert [frame.stamp_ns - RECORDED for frame in frames] == [0, SECOND // 10, 0, SECOND // 10]
    scene = glidar.Scene(ROOM)
    assert glidar.simulate(scene, "VLP-16", poses[0], **start).stamp_ns == RECORDED
    assert simulator.simulate(poses[0]).stamp_ns == 0


def test_objects_with_dates_give_the_start_where_the_sensor_has_none():
    scene = glidar.Scene.from_dict({"models": [{"model": "builtin:box"}], "sensor": "VLP-16"})
    frame = glidar.simulate(scene, pose=glidar.pose([0, -5, 0]), objects=[drive(RECORDED)], frame=5)
    assert frame.stamp_ns == RECORDED + SECOND // 2
    assert frame.world_from_objects[0][:3, 3] == pytest.approx([0.5, 0, 0], abs=1e-12)


def test_samples_of_imus_start_with_their_trajectory():
    smooth = drive(RECORDED, interpolation="spline")
    samples = glidar.simulate_imu("BMI088", smooth, 0.1)
    assert samples.t_ns[0] == RECORDED
    later = glidar.simulate_imu("BMI088", smooth, 0.05, start_ns=RECORDED + SECOND // 20, turned_on_ns=RECORDED)
    assert np.array_equal(later.t_ns, samples.t_ns[-len(later):])
    assert np.array_equal(later.angular_velocity, samples.angular_velocity[-len(later):])
    with pytest.raises(glidar.Error, match="start_s and start_ns: both are given"):
        glidar.simulate_imu("BMI088", smooth, 0.1, start_s=0.0, start_ns=0)


def test_times_in_nanoseconds_are_exact():
    trajectory = drive(RECORDED)
    assert trajectory.known_ns == (RECORDED, RECORDED + 4 * SECOND)
    assert trajectory.poses_at_ns([RECORDED + 1])[0, 0, 3] == pytest.approx(1e-9, rel=1e-12)
    for times in ([0.0, 1.0], [[0, 1]], []):
        with pytest.raises(glidar.Error, match="times_ns: an array"):
            trajectory.poses_at_ns(times)
    with pytest.raises(glidar.Error, match="times_s and times_ns: neither; allowed: one of them"):
        glidar.Trajectory.timed(None, [glidar.pose()])


def test_data_sets_keep_dates(tmp_path):
    (tmp_path / "scene.yaml").write_text(
        "models: [{model: 'builtin:box:size=20,16,6', class: building}]\n"
        "sensors: [{name: lidar, sensor: VLP-16}]\nrig_pose: {position: [0, 0, 0]}\n")  # fmt: skip
    scene = glidar.Scene(tmp_path / "scene.yaml")
    for name, options, wanted_us in (("kept", {}, RECORDED // 1000), ("given", {"start_us": 7}, 7)):
        with NuscenesWriter(tmp_path / name, **options) as data:
            data.add_scene(scene, duration_s=0.6, trajectory=drive(RECORDED))
        samples = json.loads((tmp_path / name / "v1.0-mini" / "sample.json").read_text())
        assert [sample["timestamp"] - wanted_us for sample in samples] == [0, 500_000]
        poses = json.loads((tmp_path / name / "v1.0-mini" / "ego_pose.json").read_text())
        assert poses[5]["translation"][0] - poses[0]["translation"][0] == pytest.approx(0.5, abs=1e-9)
    log = json.loads((tmp_path / "kept" / "v1.0-mini" / "log.json").read_text())
    assert log[0]["date_captured"] == "2023-11-14"
