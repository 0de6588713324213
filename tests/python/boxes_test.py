# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""3D bounding boxes of objects, in Python and in sidecars."""

import json
import pickle
import threading

import numpy as np
import pytest

import glidar

ROUNDING_M = 1e-9

SCENE = """models:
  - {model: 'builtin:box:size=4,2,1.5', name: front, id: 7, class: car, pose: {position: [8, 1, 0], euler_deg: {yaw: 30, pitch: 5}}}
  - {model: 'builtin:box:size=4,2,1.5', name: behind, id: 9, class: car, pose: {position: [14, 4, 0]}}
  - model: 'builtin:sphere:radius=1'
    name: ball
    id: 3
    class: ball
    pose: {position: [6, -4, 0]}
    motion: {twist: {velocity_m_s: [0, 2, 0]}}
  - {model: 'builtin:box:size=40,40,0.1', name: ground, pose: {position: [0, 0, -1]}}
"""


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    path = tmp_path_factory.mktemp("boxes") / "scene.yaml"
    path.write_text(SCENE)
    return glidar.Scene(path)


@pytest.fixture(scope="module")
def frame(scene):
    sensor = glidar.load_sensor("OS1-32").ground_truth()
    return glidar.simulate(scene, sensor, pose=glidar.pose([0.0, 0.0, 0.4]), columns="all")


def test_boxes_contain_the_points_of_their_objects_and_count_them(frame):
    cloud = frame.cloud(["true_xyz", "instance"])
    boxes = frame.boxes()
    assert [(box.name, box.id, box.class_name) for box in boxes] == [("front", 7, "car"), ("behind", 9, "car"), ("ball", 3, "ball")]
    for box in boxes[:2]:
        points = cloud["true_xyz"][(cloud["instance"] == box.id) & np.isfinite(cloud["true_xyz"]).all(-1)]
        assert len(points) == box.points > 20
        own = (points - box.centre_m) @ box.frame_from_box[:3, :3]
        assert (np.abs(own) <= 0.5 * box.size_m + ROUNDING_M).all()
        # a point of a box is on one of its faces
        np.testing.assert_allclose(np.abs(np.abs(own) - 0.5 * box.size_m).min(axis=1), 0.0, atol=1e-6)
        np.testing.assert_allclose(box.size_m, [4.0, 2.0, 1.5], atol=1e-6)


def test_occlusion_compares_with_the_object_alone(scene, frame):
    sensor = glidar.load_sensor("OS1-32").ground_truth()
    away = [one.pose for one in scene.objects]
    for box in frame.boxes(unlabelled=True):
        poses = np.array(away)
        poses[:, 2, 3] = 1e4
        poses[box.index] = away[box.index]
        if box.name == "ball":
            continue  # it moves while the beams are fired
        alone = glidar.simulate(scene, sensor, pose=glidar.pose([0.0, 0.0, 0.4]), objects=poses)
        visible = int((frame.ground_truth.instance == box.index).sum())
        assert box.beams == int((alone.ground_truth.instance == box.index).sum())
        assert box.visible_beams == visible
        assert box.occlusion == 1.0 - visible / box.beams
    by_name = {box.name: box for box in frame.boxes()}
    assert by_name["front"].occlusion == 0.0
    assert 0.2 < by_name["behind"].occlusion < 1.0


def test_coordinate_frames_and_velocity(frame):
    sensor, world = frame.boxes(), frame.boxes(frame="world")
    for a, b in zip(sensor, world):
        np.testing.assert_allclose(frame.world_from_sensor @ a.frame_from_box, b.frame_from_box, atol=1e-12)
    np.testing.assert_allclose(world[2].velocity_m_s, [0.0, 2.0, 0.0], atol=1e-12)
    np.testing.assert_array_equal(world[0].velocity_m_s, 0.0)
    corners = world[1].corners_m
    np.testing.assert_allclose(corners.max(0) - corners.min(0), [4.0, 2.0, 1.5], atol=1e-6)
    np.testing.assert_allclose(corners.mean(0), world[1].centre_m, atol=1e-9)
    np.testing.assert_allclose(world[1].wxyz, [1.0, 0.0, 0.0, 0.0], atol=1e-12)
    with pytest.raises(glidar.Error):
        frame.boxes(frame="nowhere")


def test_sidecars_have_the_boxes_in_the_frame_of_the_cloud(frame, tmp_path):
    for axes in ("sensor", "world"):
        frame.save(tmp_path / "a.pcd", frame=axes)
        listed = json.loads((tmp_path / "a.glidar.json").read_text())["boxes"]
        for one, box in zip(listed, frame.boxes(frame=axes), strict=True):
            assert (one["name"], one["id"], one["class"]) == (box.name, box.id, box.class_name)
            assert (one["points"], one["beams"], one["visible_beams"]) == (box.points, box.beams, box.visible_beams)
            assert one["occlusion"] == box.occlusion
            np.testing.assert_allclose(one["centre_m"], box.centre_m, atol=1e-12)
            np.testing.assert_allclose(one["size_m"], box.size_m, atol=1e-12)
            np.testing.assert_allclose([one["orientation"][k] for k in "wxyz"], box.wxyz, atol=1e-12)
            np.testing.assert_allclose(one["velocity_m_s"], box.velocity_m_s, atol=1e-12)


def test_the_program_writes_the_same_boxes(frame, scene, tmp_path, program):
    (tmp_path / "scene.yaml").write_text(SCENE)
    program("render", "scene.yaml", "--sensor", "OS1-32", "--ground-truth", "--eye", "0,0,0.4", "-o", "a.ply", folder=tmp_path)
    frame.save(tmp_path / "b.ply")
    ours, theirs = (json.loads((tmp_path / name).read_text())["boxes"] for name in ("b.glidar.json", "a.glidar.json"))
    assert ours == theirs and len(ours) == 3


def test_scenes_without_classes_have_no_boxes(tmp_path):
    plain = glidar.simulate(glidar.Scene("builtin:box"), glidar.camera(16, 12, fov_deg=40.0))
    assert plain.boxes() == []
    (box,) = plain.boxes(unlabelled=True)
    assert box.class_name == "unlabelled" and box.occlusion == 0.0
    plain.save(tmp_path / "a.pcd")
    assert json.loads((tmp_path / "a.glidar.json").read_text())["boxes"] == []


def test_an_unpickled_frame_has_the_same_boxes(frame, tmp_path):
    again = pickle.loads(pickle.dumps(frame))
    again.save(tmp_path / "a.pcd")  # finds the boxes, for which it needs a renderer
    assert again.boxes() == frame.boxes()


def test_threads_may_share_a_frame(scene):
    fresh = glidar.simulate(scene, glidar.camera(64, 48, fov_deg=60.0), pose=glidar.look_at([0, 0, 0.4], [5, 0, 0]))
    found = []
    workers = [threading.Thread(target=lambda: found.append(fresh.boxes())) for _ in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert len(found) == 4 and all(boxes == found[0] for boxes in found)


@pytest.mark.parametrize("name", ["run.mcap", "run.rosbag2"])
def test_bags_have_a_cube_for_each_box(name, tmp_path, program):
    rosbags = pytest.importorskip("rosbags.highlevel")
    stores = pytest.importorskip("rosbags.typesys")
    (tmp_path / "scene.yaml").write_text(SCENE)
    program("render", "scene.yaml", "--sensor", "VLP-16", "--eye", "0,0,0.4", "--duration", "0.2", "-o", name, folder=tmp_path)
    frames = [glidar.simulate(glidar.Scene(tmp_path / "scene.yaml"), glidar.load_sensor("VLP-16"), pose=glidar.pose([0, 0, 0.4]), frame=k)
              for k in range(2)]  # fmt: skip
    store = stores.get_typestore(stores.Stores.ROS2_HUMBLE)
    with rosbags.AnyReader([tmp_path / name], default_typestore=store) as reader:
        found = [reader.deserialize(data, topic.msgtype) for topic, _, data in reader.messages() if topic.topic == "/lidar/boxes"]
    assert len(found) == 2
    for message, frame in zip(found, frames):
        for cube, box in zip(message.markers, frame.boxes(), strict=True):
            assert (cube.ns, cube.id, cube.type, cube.header.frame_id) == (box.class_name, box.id, 1, "lidar_frame")
            assert cube.header.stamp.sec * 10**9 + cube.header.stamp.nanosec == 1767225600 * 10**9 + frame.stamp_ns  # 2026
            at, turn, size = cube.pose.position, cube.pose.orientation, cube.scale
            np.testing.assert_allclose([at.x, at.y, at.z], box.centre_m, atol=1e-12)
            np.testing.assert_allclose([turn.w, turn.x, turn.y, turn.z], box.wxyz, atol=1e-12)
            np.testing.assert_allclose([size.x, size.y, size.z], box.size_m, atol=1e-12)
            known = json.loads(cube.text)
            assert (known["points"], known["beams"], known["visible_beams"]) == (box.points, box.beams, box.visible_beams)


def test_scenes_without_classes_have_no_topic_of_boxes(tmp_path, program):
    rosbags = pytest.importorskip("rosbags.highlevel")
    program("render", "builtin:box", "--sensor", "VLP-16", "--eye", "3,0,0", "-o", "run.mcap", folder=tmp_path)
    with rosbags.AnyReader([tmp_path / "run.mcap"]) as reader:
        assert "/lidar/points" in reader.topics and "/lidar/boxes" not in reader.topics


TOWN = """models:
  - {model: 'builtin:box:size=4,2,1.5', name: front, class: car, pose: {position: [8, 1, 0]}}
  - {model: 'builtin:box:size=9,9,6', name: home, class: house, pose: {position: [20, -8, 0]}}
  - {model: 'builtin:box:size=120,6,0.1', name: lane, class: road, pose: {position: [0, 0, -1]}}
"""


def listed_classes(sidecar):
    return [box["class"] for box in json.loads(sidecar.read_text())["boxes"]]


def test_only_countable_classes_have_boxes_unless_others_are_named(tmp_path, program):
    (tmp_path / "town.yaml").write_text(TOWN)
    (tmp_path / "named.yaml").write_text(TOWN + "box_classes: [car, road]\n")
    common = ("--sensor", "VLP-16", "--eye", "0,0,0.4")
    for file, options, classes in (
        ("town.yaml", (), ["car"]),
        ("town.yaml", ("--box-classes", "house,road"), ["house", "road"]),
        ("town.yaml", ("--box-classes", "all"), ["car", "house", "road"]),
        ("named.yaml", (), ["car", "road"]),
        ("named.yaml", ("--box-classes", "house"), ["house"]),
    ):
        program("render", file, *common, *options, "-o", "a.pcd", folder=tmp_path)
        assert listed_classes(tmp_path / "a.glidar.json") == classes
    town = glidar.Scene(tmp_path / "town.yaml")
    frame = glidar.simulate(town, glidar.load_sensor("VLP-16"), pose=glidar.pose([0, 0, 0.4]))
    assert [box.class_name for box in frame.boxes()] == ["car"]
    assert [box.class_name for box in frame.boxes(classes=["house"])] == ["house"]
    assert [box.class_name for box in frame.boxes(classes="all")] == ["car", "house", "road"]
    assert frame.boxes(classes=[]) == []
    with pytest.raises(glidar.Error, match="did you mean 'house'"):
        frame.boxes(classes=["hous"])


def test_box_classes_of_a_scene_are_kept_and_compared():
    town = glidar.Scene.from_dict({"models": [
        {"model": "builtin:box", "class": "car"}, {"model": "builtin:box", "class": "house", "pose": {"position": [5, 0, 0]}}]})
    other = pickle.loads(pickle.dumps(town))
    town.box_classes = ["house"]
    assert town.box_classes == ["house"] and town != other
    assert pickle.loads(pickle.dumps(town)) == town
    frame = glidar.simulate(town, glidar.camera(16, 12, fov_deg=40.0))
    assert [box.class_name for box in frame.boxes()] == ["house"]
    with pytest.raises(glidar.Error, match="box_classes"):
        town.box_classes = ["boat"]
    with pytest.raises(glidar.Error, match="box_classes"):
        glidar.Scene.from_dict({"models": [{"model": "builtin:box", "class": "car"}], "box_classes": ["cart"]})


def test_bags_have_boxes_of_countable_classes_only(tmp_path, program):
    rosbags = pytest.importorskip("rosbags.highlevel")
    (tmp_path / "town.yaml").write_text(TOWN)
    program("render", "town.yaml", "--sensor", "VLP-16", "--eye", "0,0,0.4", "-o", "run.mcap", folder=tmp_path)
    with rosbags.AnyReader([tmp_path / "run.mcap"]) as reader:
        found = [reader.deserialize(data, topic.msgtype) for topic, _, data in reader.messages() if topic.topic == "/lidar/boxes"]
    assert [cube.ns for message in found for cube in message.markers] == ["car"]
