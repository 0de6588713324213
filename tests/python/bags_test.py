# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""ROS bags of frames, read by rosbags."""

import numpy as np
import pytest
from rosbags.highlevel import AnyReader

import glidar

NAMES = ["run.mcap", "run.rosbag2"]


@pytest.fixture(scope="module")
def scene():
    return glidar.Scene("builtin:box:size=8,8,8")


def messages(path):
    with AnyReader([path]) as reader:
        found = {}
        for connection, time_ns, raw in reader.messages():
            found.setdefault(connection.topic, []).append((time_ns, reader.deserialize(raw, connection.msgtype)))
        return found


def write(path, frames, **options):
    with glidar.open_output(path, **options) as bag:
        for frame in frames:
            bag.write(frame)


def first_firing_ns(frame):
    return frame.stamp_ns + int(frame.cloud("time")["time"].min())


def points(cloud):
    """x, y and z of the points of a PointCloud2."""
    data = np.frombuffer(cloud.data, dtype=np.uint8).reshape(-1, cloud.point_step)
    return np.stack([data[:, f.offset:f.offset + 4].copy().view("<f4")[:, 0] for f in cloud.fields[:3]], axis=1)


@pytest.mark.parametrize("name", NAMES)
def test_a_frame_is_saved_as_a_bag(scene, tmp_path, name):
    frame = glidar.simulate(scene, glidar.sensor("VLP-16"), pose=glidar.pose([0.5, 0.25, 0.125]))
    frame.save(tmp_path / name)
    found = messages(tmp_path / name)
    (_, cloud), = found["/lidar/points"]
    expected = frame.cloud("xyz", drop_invalid=True)["xyz"]
    assert np.array_equal(np.sort(points(cloud), axis=0), np.sort(expected.reshape(-1, 3).astype(np.float32), axis=0))
    (_, odometry), = found["/ground_truth/odom"]
    assert [odometry.pose.pose.position.x, odometry.pose.pose.position.y] == [0.5, 0.25]
    assert odometry.twist.covariance[0] == -1.0


@pytest.mark.parametrize("name", NAMES)
def test_frames_are_saved_in_one_bag_in_the_order_of_time(scene, tmp_path, name):
    simulator = glidar.Simulator(scene, glidar.sensor("VLP-16"))
    frames = [simulator.simulate(glidar.pose([0.1 * k, 0, 0]), frame=k) for k in range(3)]
    write(tmp_path / name, iter(frames), layout="velodyne")
    found = messages(tmp_path / name)
    assert [time_ns for time_ns, _ in found["/lidar/points"]] == [first_firing_ns(frame) for frame in frames]
    assert [field.name for field in found["/lidar/points"][0][1].fields] == ["x", "y", "z", "intensity", "ring", "time"]
    assert found["/ground_truth/odom"][2][1].twist.twist.linear.x == pytest.approx(1.0, rel=1e-3)
    assert "/tf_static" in found


def test_the_depth_of_a_camera_is_an_image(scene, tmp_path):
    frame = glidar.simulate(scene, glidar.camera(20, 10, fov_deg=40))
    frame.save(tmp_path / "run.mcap")
    (_, image), = messages(tmp_path / "run.mcap")["/camera/depth/image_raw"]
    depth = np.frombuffer(image.data, dtype="<f4").reshape(10, 20)
    assert np.array_equal(depth, frame.cloud("depth")["depth"].astype(np.float32), equal_nan=True)


def test_errors_leave_an_existing_bag_unchanged(scene, tmp_path):
    path = tmp_path / "run.mcap"
    frame = glidar.simulate(scene, glidar.sensor("VLP-16"))
    frame.save(path)
    before = path.read_bytes()
    other = glidar.simulate(scene, glidar.camera(20, 10, fov_deg=40))
    for frames, text in (([], "no frame"), ([frame, other], "another sensor"), ([frame, 5], "a int")):
        with pytest.raises(glidar.Error, match=text):
            write(path, frames)
        assert path.read_bytes() == before
    with pytest.raises(glidar.Error, match=r"\.rosbag2"):
        glidar.open_output(tmp_path / "run.rosbag")
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["run.mcap"]
