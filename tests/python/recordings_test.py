# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Bags and packet captures of ``glidar render``, read by rosbags. The built program is found in PATH."""

import signal
import subprocess

import numpy as np
import pytest
from cloud_message import points_of
from waiting import wait_until

highlevel = pytest.importorskip("rosbags.highlevel")
typesys = pytest.importorskip("rosbags.typesys")

RIG = """models: [{model: builtin:box, pose: {position: [4, 0, 0]}}]
sensors:
  - {name: lidar, sensor: VLP-16}
  - {name: camera, sensor: {optics: {type: pinhole, width: 32, height: 24, fx: 30, fy: 30, cx: 16, cy: 12}}}
imus: [{name: imu, imu: {rate_hz: 100}}]
rig_pose: {position: [0, 0, 0.5]}
rig_motion: {twist: {velocity_m_s: [1, 0, 0], rate_rad_s: [0, 0, 0.5], frame: body}}
"""


def run(folder, *arguments):
    return subprocess.run(["glidar", "render", *arguments], cwd=folder, capture_output=True, text=True, check=False)


def messages(bag):
    """Messages of a bag by topic, as (time, message)."""
    found = {}
    store = typesys.get_typestore(typesys.Stores.LATEST)
    with highlevel.AnyReader([bag], default_typestore=store) as reader:
        for connection, stamp, raw in reader.messages():
            found.setdefault(connection.topic, []).append((stamp, reader.deserialize(raw, connection.msgtype)))
    return found


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("recordings")
    (place / "rig.yaml").write_text(RIG)
    done = run(place, "rig.yaml", "--duration", "0.2", "-o", "run.mcap", "-o", "run.rosbag2")
    assert done.returncode == 0, done.stderr
    assert "wrote run.mcap" in done.stdout
    return place


@pytest.mark.parametrize("name", ["run.mcap", "run.rosbag2"])
def test_a_bag_has_all_sensors_of_a_rig_with_their_frames_and_ground_truth(folder, name):
    found = messages(folder / name)
    images = {f"/camera/{name}/{kind}" for name in ("depth", "intensity", "color") for kind in ("image_raw", "camera_info")}
    assert set(found) == {"/lidar/points", "/camera/points", *images, "/imu/data", "/tf", "/tf_static",
                          "/ground_truth/odom", "/clock"}  # fmt: skip
    stamps = [cloud.header.stamp.sec * 10**9 + cloud.header.stamp.nanosec for _, cloud in found["/lidar/points"]]
    start_ns = 1767225600 * 10**9  # 2026
    assert [stamp - start_ns for stamp in stamps] == pytest.approx([0, 1e8], abs=2e5)  # frames begin with a firing
    assert len(found["/camera/points"]) == 6
    static = {t.child_frame_id for t in found["/tf_static"][0][1].transforms}
    assert static == {"lidar", "camera_link", "camera_depth_optical_frame", "imu"}
    assert found["/lidar/points"][0][1].header.frame_id == "lidar"
    times = [stamp for stamp, _ in found["/tf"]]
    steps = range(start_ns, start_ns + 200_000_001, 10_000_000)
    assert set(times) >= {*steps, *stamps, *(stamp for stamp, _ in found["/camera/points"])}
    assert (np.diff(times) > 0).all()
    assert times == [stamp for stamp, _ in found["/ground_truth/odom"]] == [stamp for stamp, _ in found["/clock"]]
    assert times[-1] == start_ns + 200_000_000
    odometry = found["/ground_truth/odom"][-1][1]
    assert odometry.twist.twist.linear.x == pytest.approx(1.0, abs=1e-12)
    assert odometry.twist.twist.angular.z == pytest.approx(0.5, abs=1e-12)
    imu = found["/imu/data"][0][1]
    assert imu.linear_acceleration.z == pytest.approx(9.80665, abs=1e-9)
    assert imu.linear_acceleration.y == pytest.approx(0.5, abs=1e-9)  # centripetal: v w
    assert imu.orientation_covariance[0] == -1


def test_a_bag_is_written_in_the_order_of_time(folder):
    """Frames are in the order of their start; a frame's stamp is its first firing, up to some firings later. rosbags
    sorts messages, so the file is read directly."""
    reader = pytest.importorskip("mcap.reader")
    with open(folder / "run.mcap", "rb") as file:
        times = [m.log_time for _, _, m in reader.make_reader(file).iter_messages(log_time_order=False)]
    assert len(times) > 100
    assert (np.diff(times) > -100_000).all()


def test_points_of_a_cloud_are_dense_in_firing_order_and_on_the_box(folder):
    cloud = messages(folder / "run.mcap")["/lidar/points"][0][1]
    assert cloud.is_dense and cloud.height == 1
    points = points_of(cloud).ravel()
    assert len(points) > 100
    assert (np.diff(points["time"].astype(np.int64)) >= 0).all()
    assert np.isfinite(points["x"]).all()
    length = np.sqrt(points["x"] ** 2 + points["y"] ** 2 + points["z"] ** 2)
    assert np.abs(length - points["range"]).max() < 0.1  # the beams' origins are near the sensor's


def test_a_layout_gives_the_fields_of_its_driver(tmp_path):
    done = run(tmp_path, "builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0", "--layout", "velodyne", "-o", "a.mcap")
    assert done.returncode == 0, done.stderr
    cloud = messages(tmp_path / "a.mcap")["/lidar/points"][0][1]
    assert [(field.name, field.offset) for field in cloud.fields] == [
        ("x", 0), ("y", 4), ("z", 8), ("intensity", 12), ("ring", 16), ("time", 18)]  # fmt: skip
    assert cloud.point_step == 22


def test_a_capture_has_the_packets_of_one_revolution(tmp_path):
    done = run(tmp_path, "builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0", "-o", "a.pcap")
    assert done.returncode == 0, done.stderr
    data = (tmp_path / "a.pcap").read_bytes()
    lengths = []
    at = 24
    while at < len(data):
        size = int.from_bytes(data[at + 8 : at + 12], "little")
        lengths.append(size - 42)  # Ethernet, IPv4 and UDP
        at += 16 + size
    assert lengths.count(1206) >= 75
    assert set(lengths) <= {1206, 512}


def test_a_capture_of_a_rig_has_the_sensor_with_packets(folder):
    done = run(folder, "rig.yaml", "-o", "rig.pcap")
    assert done.returncode == 0, done.stderr
    assert (folder / "rig.pcap").stat().st_size > 75 * 1206


def test_a_stream_completes_its_bag_after_sigint_and_a_replay_repeats_it(tmp_path):
    (tmp_path / "rig.yaml").write_text(RIG)
    words = ["rig.yaml", "--record", "r.jsonl", "-o", "live.mcap", "-o", "live.rosbag2", "-o", "live.pcd", "--no-sidecar"]
    with subprocess.Popen(["glidar", "stream", *words], cwd=tmp_path, stdout=subprocess.DEVNULL) as program:
        wait_until((tmp_path / "live_lidar_000002.pcd").exists, "three frames", program)
        program.send_signal(signal.SIGINT)
    assert program.returncode == 130
    live = messages(tmp_path / "live.mcap")
    count = len(live["/lidar/points"])
    assert count >= 3
    assert len(messages(tmp_path / "live.rosbag2")["/lidar/points"]) == count
    assert len(live["/imu/data"]) >= 10 * count
    done = subprocess.run(["glidar", "replay", "r.jsonl", "-o", "again.mcap"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    done = run(tmp_path, "rig.yaml", "--duration", str(count / 10), "-o", "rendered.mcap")
    assert done.returncode == 0, done.stderr
    for name in ("again.mcap", "rendered.mcap"):
        other = messages(tmp_path / name)
        assert set(other) == set(live)
        for (stamp, cloud), (other_stamp, other_cloud) in zip(live["/lidar/points"], other["/lidar/points"], strict=True):
            assert stamp == other_stamp
            assert cloud.data.tobytes() == other_cloud.data.tobytes()


@pytest.mark.parametrize(("arguments", "text"), [
    (("builtin:box", "-o", "a.pcap"), "depth camera"),
    (("rig.yaml", "-o", "a.pcap"), "several sensors with packets: lidar, second"),
    (("builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0", "-o", "a.mcap", "-o", "./a.mcap"), "is given twice"),
    (("builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0", "-o", "missing/a.mcap"), "missing"),
])  # fmt: skip
def test_recordings_that_do_not_fit_are_refused_and_leave_nothing(tmp_path, arguments, text):
    (tmp_path / "rig.yaml").write_text(RIG.replace("imus:", "  - {name: second, sensor: XT32}\nimus:"))
    done = run(tmp_path, *arguments)
    assert done.returncode == 2
    assert text in done.stderr
    assert [file.name for file in tmp_path.iterdir()] == ["rig.yaml"]
