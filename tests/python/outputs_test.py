# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Outputs of Python have the bytes of those of the command line."""

import json
import socket
import struct

import numpy as np
import pytest

import glidar

SCENE = """
models:
  - {model: 'builtin:box:size=20,20,8', name: room, class: wall}
  - {model: 'builtin:asteroid', name: rock, id: 4, class: rock, pose: {position: [4, -3, 0]}}
rig_pose: {position: [1, 0, 0.5]}
sensors:
  - {name: roof, sensor: VLP-16, pose: {position: [0, 0, 1.5]}}
  - {name: eye, sensor: {optics: {type: pinhole, width: 60, height: 40, fov_deg: 90}, rate_hz: 10},
     pose: {position: [0.5, 0, 1], euler_deg: {roll: -90, yaw: -70}}}
imus:
  - {name: imu, imu: BMI088}
"""
START_NS = 1_600_000_000_000_000_000
RIG = glidar.Trajectory.constant(glidar.pose([1, 0, 0.5]))
NAMES = ["run.mcap", "run.rosbag2", "run.osi", "run.kitti", "run.pcap", "run.pcd", "run.las", "run.npz", "run.imu.csv"]


@pytest.fixture(scope="module")
def scene_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("outputs") / "scene.yaml"
    path.write_text(SCENE)
    return path


@pytest.fixture(scope="module")
def scene(scene_file):
    return glidar.Scene(scene_file)


@pytest.fixture(scope="module")
def frames(scene):
    """Two frames of both sensors, in the order of time."""
    return [
        frame
        for number in range(2)
        for frame in glidar.simulate_rig(scene, frame=number, columns="all", start_ns=START_NS).values()
    ]


def write(path, frames, sensor=None, **options):
    with glidar.open_output(path, sensor, **options) as output:
        for frame in frames:
            output.write(frame)


def contents(folder):
    """The bytes of all files, but not the commands that sidecars have."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_dir():
            continue
        data = path.read_bytes()
        if path.name.endswith(".glidar.json"):
            text = json.loads(data)
            text.pop("command", None)
            data = json.dumps(text)
        found[str(path.relative_to(folder))] = data
    return found


@pytest.mark.parametrize("name", NAMES)
def test_output_is_byte_identical_to_that_of_the_command_line(name, scene_file, scene, frames, tmp_path, program):
    theirs, ours = tmp_path / "theirs", tmp_path / "ours"
    theirs.mkdir()
    ours.mkdir()
    program("render", scene_file, "--duration", 0.2, "--start-time", START_NS // 10**9, "-o", theirs / name)
    write(ours / name, frames, scene.rig, trajectory=RIG, imus=glidar.rig_imus(scene), start_ns=START_NS)
    assert list(contents(ours)) == list(contents(theirs))
    assert contents(ours) == contents(theirs)


def test_every_format_of_the_table_is_documented_and_its_suffix_is_known(tmp_path):
    formats = glidar.output_formats()
    assert {".pcd", ".las", ".mcap", ".pcap", ".osi", ".kitti", ".imu.csv"} <= set(formats)
    for suffix, description in formats.items():
        assert description
        glidar.open_output(tmp_path / f"a{suffix}").discard()
    assert not list(tmp_path.iterdir())


def test_a_frame_is_saved_as_a_recording(frames, tmp_path):
    for name in ("one.pcap", "one.osi", "one.mcap"):
        frames[0].save(tmp_path / name)
        write(tmp_path / f"same_{name}", frames[:1])
        assert (tmp_path / name).read_bytes() == (tmp_path / f"same_{name}").read_bytes()


def test_close_names_what_was_written(frames, tmp_path):
    output = glidar.open_output(tmp_path / "scan.pcd", sidecar=False, per_frame=True)
    for frame in frames[::2]:
        output.write(frame)
    assert output.close() == [f"wrote {tmp_path}/scan_000000.pcd to {tmp_path}/scan_000001.pcd (2 files)"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["scan_000000.pcd", "scan_000001.pcd"]


def test_one_cloud_has_all_frames_unless_requested_otherwise(frames, tmp_path):
    write(tmp_path / "scan.ply", frames[::2])
    header = (tmp_path / "scan.ply").read_bytes().split(b"end_header")[0]
    beams = sum(frame.rows * frame.cols for frame in frames[::2])
    assert f"element vertex {beams}\n".encode() in header and b"property uint frame\n" in header
    assert sorted(path.name for path in tmp_path.iterdir()) == ["scan.glidar.json", "scan.ply"]
    described = json.loads((tmp_path / "scan.glidar.json").read_text())
    assert [one["points"]["scan.ply"] for one in described["frames"]] == [frame.rows * frame.cols for frame in frames[::2]]
    assert len({one["stamp_ns"] for one in described["frames"]}) == len(frames[::2])


@pytest.mark.parametrize("name, given", [("a.npy", {"layout": "velodyne"}), ("a.pcap", {"layout": "velodyne"}),
                                         ("a.pcd", {"crs": "EPSG:32632"}), ("a.mcap", {"crs": "EPSG:32632"})])
def test_options_that_an_output_ignores_are_errors(frames, tmp_path, name, given):
    with pytest.raises(glidar.Error, match=f"leave {next(iter(given))} out"):
        frames[0].save(tmp_path / name, **given)
    output = glidar.open_output(tmp_path / name, **given)
    with pytest.raises(glidar.Error, match=f"leave {next(iter(given))} out"):
        output.write(frames[0])


def test_options_change_the_packets(scene, tmp_path):
    frame = glidar.simulate(scene, "OS1-32", np.eye(4))
    for profile in ("LEGACY", "RNG15_RFL8_NIR8"):
        write(tmp_path / f"{profile}.pcap", [frame], ouster_profile=profile)
        metadata = json.loads((tmp_path / f"{profile}.json").read_text())
        assert metadata["config_params"]["udp_profile_lidar"] == profile


def captured(path):
    """The lengths of the packets' payloads in a pcap file."""
    data, at, lengths = path.read_bytes(), 24, []
    while at < len(data):
        size = struct.unpack_from("<I", data, at + 8)[0]
        lengths.append(size - 42)  # Ethernet, IPv4 and UDP
        at += 16 + size
    return lengths


def test_packets_are_sent_by_udp(frames, tmp_path):
    frames[0].save(tmp_path / "scan.pcap")
    expected = captured(tmp_path / "scan.pcap")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        receiver.bind(("127.0.0.1", 0))
        port = receiver.getsockname()[1]
        write(f"udp://127.0.0.1:{port}:{port}", frames[:1])
        receiver.settimeout(60)
        assert sorted(len(receiver.recv(2000)) for _ in expected) == sorted(expected)


def test_an_exception_leaves_nothing(frames, tmp_path):
    with pytest.raises(RuntimeError), glidar.open_output(tmp_path / "run.mcap") as output:
        output.write(frames[0])
        raise RuntimeError
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("name", "options", "text"),
    [
        ("run.mcp", {}, r"did you mean \.mcap\?"),
        ("run", {}, "no suffix"),
        ("run.mcap", {"layout": "velodyne", "columns": "xyz"}, "both are given"),
        ("run.pcap", {"ouster_profile": "NEW"}, "LEGACY"),
        ("run.mcap", {"driver": "oster"}, "did you mean"),
        ("run.pcap", {"livox_data_type": 9}, "0 to 3"),
        ("run.imu.csv", {"imus": {"a": glidar.RigImu}}, "without a trajectory"),
    ],
)
def test_wrong_arguments_are_refused_at_once(name, options, text, tmp_path):
    with pytest.raises(glidar.Error, match=text):
        glidar.open_output(tmp_path / name, **options)


@pytest.mark.parametrize(
    ("name", "number", "text"),
    [("run.pcap", 1, "camera"), ("run.imu.csv", 0, "no IMU"), ("nothing/run.mcap", 0, "nothing"), ("udp://:1", 0, "ADDRESS")],
)
def test_an_output_that_does_not_fit_is_refused_with_the_first_frame(name, number, text, frames, tmp_path):
    with pytest.raises(glidar.Error, match=text):
        write(name if "://" in name else tmp_path / name, frames[number:])
    assert not list(tmp_path.iterdir())


def test_an_input_is_not_replaced(tmp_path):
    (tmp_path / "room.npz").write_bytes(b"")
    (tmp_path / "scene.yaml").write_text("models: [{model: 'builtin:box'}]\nsensor: VLP-16\n")
    link = tmp_path / "link.osi"
    link.symlink_to(tmp_path / "scene.yaml")
    frame = glidar.simulate(glidar.Scene(tmp_path / "scene.yaml"), pose=np.eye(4))
    with pytest.raises(glidar.Error, match="input"):
        write(link, [frame])
    assert (tmp_path / "scene.yaml").read_text().startswith("models")


@pytest.mark.parametrize("name", ["run.npz", "run.mcap", "run.osi"])
def test_a_frame_of_a_scene_with_other_objects_is_refused(name, tmp_path):
    one = glidar.Scene("builtin:box")
    two = glidar.Scene("builtin:box")
    two.add_instance(two.objects[0], pose=glidar.pose([0, 3, 0]))
    first, second = (glidar.simulate(scene, "VLP-16", glidar.pose([5, 0, 0])) for scene in (one, two))
    with glidar.open_output(tmp_path / name) as output:
        output.write(first)
        with pytest.raises(glidar.Error, match="other objects than the first"):
            output.write(second)
        output.write(first)


def test_an_output_that_has_ended_takes_no_frames_and_keeps_its_file(frames, tmp_path):
    output = glidar.open_output(tmp_path / "run.mcap")
    output.write(frames[0])
    assert output.close()
    written = (tmp_path / "run.mcap").read_bytes()
    with pytest.raises(glidar.Error, match="the output has ended"):
        output.write(frames[0])
    assert output.close() == []
    output.discard()
    assert (tmp_path / "run.mcap").read_bytes() == written
    discarded = glidar.open_output(tmp_path / "other.mcap")
    discarded.discard()
    with pytest.raises(glidar.Error, match="the output has ended"):
        discarded.write(frames[0])


def test_an_output_that_could_not_be_opened_takes_other_frames(frames, tmp_path):
    with glidar.open_output(tmp_path / "run.osi", "VLP-16") as output:
        with pytest.raises(glidar.Error, match="a frame of another sensor"):
            output.write(frames[1])
        assert not list(tmp_path.iterdir())
        output.write(frames[0])


def test_save_sends_nothing(frames):
    with pytest.raises(glidar.Error, match="the address of a network"):
        frames[0].save("udp://127.0.0.1:5555")
