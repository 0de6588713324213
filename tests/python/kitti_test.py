# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""KITTI folders, read by an independent reader that follows the readme of the object development kit."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import glidar

EXAMPLES = Path(__file__).parents[2] / "examples"
ROUNDING_M = 1e-5  # labels have six decimals, points are float32

SCENE = """models:
  - {model: 'builtin:box', name: a, id: 7, class: parked car, scale: 1.5, pose: {position: [8, 2, 0], euler_deg: {yaw: 30}}}
  - {model: 'builtin:asteroid', id: 9, class: rock, scale: 2, pose: {position: [-6, 3, 0.5], euler_deg: {roll: 20, pitch: 40, yaw: 70}}}
  - {model: 'builtin:box', name: on end, id: 8, class: parked car, pose: {position: [6, -4, 0.3], euler_deg: {pitch: 90, yaw: 10}}}
  - {model: 'builtin:sphere', name: unknown, pose: {position: [7, 7, 0]}}
"""


def read_calibration(path):
    lines = dict(line.split(":") for line in path.read_text().splitlines())
    return {name: np.array(text.split(), float).reshape(3, -1) for name, text in lines.items()}


def read_labels(path):
    objects = []
    for line in path.read_text().splitlines():
        words = line.split()
        assert len(words) == 15
        numbers = [float(word) for word in words[1:]]
        objects.append({"type": words[0], "truncated": numbers[0], "occluded": int(words[2]), "alpha": numbers[2],
                        "bbox": np.array(numbers[3:7]), "hwl": np.array(numbers[7:10]),
                        "location": np.array(numbers[10:13]), "rotation_y": numbers[13]})  # fmt: skip
    return objects


def in_box(points, box):
    """Coordinates along length, height (down) and width from the box's lower face, as fractions are not:
    computeBox3D.m of the development kit, backwards."""
    c, s = np.cos(box["rotation_y"]), np.sin(box["rotation_y"])
    rotation = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return (points - box["location"]) @ rotation


@pytest.fixture(scope="module", params=["lidar", "camera"])
def folder(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp(request.param)
    (folder / "scene.yaml").write_text(SCENE)
    scene = glidar.Scene(folder / "scene.yaml")
    if request.param == "lidar":
        sensor = glidar.load_sensor("OS1-64").ground_truth()
        pose = glidar.pose([0.0, 0.0, 0.4])
    else:
        sensor = glidar.camera(200, 160, fov_deg=90.0)
        pose = glidar.pose([0.0, 0.0, 0.4], matrix=[[0, 0, 1], [-1, 0, 0], [0, -1, 0]])  # looks along x
    glidar.simulate(scene, sensor, pose=pose, columns="all").save(folder / "out.kitti")
    return folder / "out.kitti"


def test_every_box_fits_the_points_of_its_instance(folder):
    points = np.fromfile(folder / "velodyne" / "000000.bin", "<f4").reshape(-1, 4)
    labels = np.fromfile(folder / "labels" / "000000.label", "<u4")
    assert len(points) == len(labels) > 500
    assert points[:, 3].min() >= 0 and points[:, 3].max() <= 1
    calibration = read_calibration(folder / "calib" / "000000.txt")
    assert set(calibration) == {"P0", "P1", "P2", "P3", "R0_rect", "Tr_velo_to_cam", "Tr_imu_to_velo"}
    to_camera = calibration["R0_rect"] @ calibration["Tr_velo_to_cam"]
    in_camera = np.column_stack([points[:, :3], np.ones(len(points))]) @ to_camera.T
    boxes = [box for box in read_labels(folder / "label_2" / "000000.txt") if box["type"] != "DontCare"]
    order = [instance for instance in (7, 9, 8) if (labels >> 16 == instance).any()]
    assert len(order) == len(boxes) >= 2
    for instance, box in zip(order, boxes):
        own = in_box(in_camera[labels >> 16 == instance], box)
        h, w, l = box["hwl"]
        low, high = np.array([-l / 2, -h, -w / 2]), np.array([l / 2, 0, w / 2])
        assert (own >= low - ROUNDING_M).all() and (own <= high + ROUNDING_M).all(), instance
        # the visible points of a rotated cube are on faces across its length or its width
        if instance == 7:
            gap = np.minimum(np.abs(own.min(0) - low), np.abs(high - own.max(0)))
            assert min(gap[0], gap[2]) < ROUNDING_M
        assert {"parked_car", "rock"} >= {box["type"]}
        assert box["occluded"] in (0, 1, 2)


def test_boxes_fit_the_meshes_and_their_images(folder):
    calibration = read_calibration(folder / "calib" / "000000.txt")
    boxes = read_labels(folder / "label_2" / "000000.txt")
    p2 = calibration["P2"]
    car = next(box for box in boxes if box["type"] == "parked_car")
    h, w, l = car["hwl"]
    np.testing.assert_allclose([w, l], h, atol=ROUNDING_M)  # builtin:box is a cube, here level
    c, s = np.cos(car["rotation_y"]), np.sin(car["rotation_y"])
    corners = np.array([[x, y, z] for x in (-l / 2, l / 2) for y in (-h, 0) for z in (-w / 2, w / 2)])
    corners = corners @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T + car["location"]
    image = np.column_stack([corners, np.ones(8)]) @ p2.T
    pixels = image[:, :2] / image[:, 2:]
    wanted = np.concatenate([pixels.min(0), pixels.max(0)])
    if car["truncated"] == 0:
        np.testing.assert_allclose(car["bbox"], wanted, atol=0.01)  # pixels; rounding by 1e-6 m at 8 m
    else:
        assert (car["bbox"][:2] >= wanted[:2] - 0.01).all() and (car["bbox"][2:] <= wanted[2:] + 0.01).all()
    # 30 degrees to the left: KITTI's rotation_y starts at the camera's x axis and is clockwise when seen from above
    np.testing.assert_allclose(car["rotation_y"], -np.deg2rad(30 + 90), atol=1e-6)
    x, _, z = car["location"]
    alpha = car["rotation_y"] - np.arctan2(x, z)
    np.testing.assert_allclose(np.exp(1j * car["alpha"]), np.exp(1j * alpha), atol=1e-5)


def saved_camera_frame(scene, camera, folder, position=(0.0, 0.0, 0.0)):
    """The boxes of label_2 and the pixels of the image of instances."""
    pose = glidar.pose(position, matrix=[[0, 0, 1], [-1, 0, 0], [0, -1, 0]])  # looks along x
    frame = glidar.simulate(scene, camera, pose=pose, columns="all")
    frame.save(folder / "out.kitti")
    frame.save(folder / "out.instance.png")
    pixels = np.array(Image.open(folder / "out.instance.png")).astype(int)
    return read_labels(folder / "out.kitti" / "label_2" / "000000.txt"), pixels


def pixel_box(found):
    v, u = np.nonzero(found)
    return np.array([u.min(), v.min(), u.max(), v.max()], float)


PARTLY_BEHIND = {
    "floor": {"model": "builtin:box:size=30,6,0.2", "position": [-5, 2, -1.5]},
    "wall at the side": {"model": "builtin:box:size=20,0.3,3", "position": [-4, -2, 0.5], "yaw": 20},
    "room around": {"model": "builtin:box:size=8,6,3", "position": [1, 0, 0]},
    "beam overhead": {"model": "builtin:box:size=12,0.4,0.4", "position": [3, 0.5, 1.2], "yaw": -10},
    "in front": {"model": "builtin:sphere:radius=1", "position": [6, 1, 0]},
    "cut off": {"model": "builtin:torus", "position": [4, 3, 0.5], "yaw": 50},
}


@pytest.mark.parametrize("name", PARTLY_BEHIND)
def test_bbox_covers_the_pixels_of_an_object_rendered_alone(tmp_path, name):
    about = PARTLY_BEHIND[name]
    scene = glidar.Scene()
    yaw = np.deg2rad(about.get("yaw", 0))
    turned = [[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]]
    scene.add_model(about["model"], name=name, id=5, class_name="thing",
                    pose=glidar.pose(about["position"], matrix=turned))  # fmt: skip
    (box,), pixels = saved_camera_frame(scene, glidar.camera(240, 160, fov_deg=80.0), tmp_path)
    wanted = pixel_box(pixels == 5)
    # beams go through pixel centres, so less than one pixel is missing at each side
    assert (box["bbox"][:2] <= wanted[:2] + 0.001).all() and (box["bbox"][2:] >= wanted[2:] - 0.001).all()
    np.testing.assert_allclose(box["bbox"], wanted, atol=1.01)
    assert (box["truncated"] == 0) == (name == "in front")
    assert (box["truncated"] > 0.99) == (name not in ("in front", "cut off"))


def test_boxes_of_the_street_contain_their_pixels_and_the_pavement_is_plausible(tmp_path):
    scene = glidar.Scene(EXAMPLES / "street.yaml")
    scene.box_classes = "all"
    boxes, pixels = saved_camera_frame(scene, glidar.camera(320, 200, fov_deg=80.0), tmp_path, (0.0, -0.9, 1.9))
    instances = np.unique(pixels[pixels > 0])
    assert len(boxes) >= len(instances) > 10
    for instance in instances:
        wanted = pixel_box(pixels == instance)
        holding = [b for b in boxes if (b["bbox"][:2] <= wanted[:2] + 0.001).all()
                   and (b["bbox"][2:] >= wanted[2:] - 0.001).all()]  # fmt: skip
        assert holding, instance
    pavement = next(box for box in boxes if box["type"] == "pavement")
    horizon = (200 - 1) / 2
    assert pavement["bbox"][1] > horizon, "it is below the camera"
    np.testing.assert_allclose(pavement["bbox"][[0, 2, 3]], [0, 319, 199], atol=1e-6)


def test_objects_without_a_class_are_labelled_dont_care(folder):
    unknown = [box for box in read_labels(folder / "label_2" / "000000.txt") if box["type"] == "DontCare"]
    assert unknown, "the sphere is in the image of both sensors"
    for box in unknown:
        assert box["truncated"] == box["occluded"] == -1 and box["alpha"] == -10
        assert (box["hwl"] == -1).all() and (box["location"] == -1000).all() and box["rotation_y"] == -10
        assert (box["bbox"][2:] > box["bbox"][:2]).all()


def test_a_bin_file_has_a_label_file_when_the_scene_has_classes(tmp_path):
    (tmp_path / "scene.yaml").write_text(SCENE)
    frame = glidar.simulate(glidar.Scene(tmp_path / "scene.yaml"), glidar.load_sensor("VLP-16"),
                            pose=np.eye(4), seed=3, columns="all")  # fmt: skip
    frame.save(tmp_path / "a.bin", sidecar=False)
    cloud = frame.cloud(["xyz", "instance", "class"], drop_invalid=True)
    none = cloud["instance"] == 0xFFFFFFFF
    wanted = np.where(none, 0, cloud["class"] | cloud["instance"] << 16).ravel()
    np.testing.assert_array_equal(np.fromfile(tmp_path / "a.label", "<u4"), wanted)
    plain = glidar.simulate(glidar.Scene("builtin:box"), glidar.load_sensor("VLP-16"), pose=glidar.pose([0, 0, 0]), columns="all")
    plain.save(tmp_path / "b.bin", sidecar=False)
    assert not (tmp_path / "b.label").exists()
