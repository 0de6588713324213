# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Depth images reconstructed from their sidecars with Open3D and OpenCV, and ground truth images."""

import json
import re

import cv2
import numpy as np
import open3d as o3d
import pytest
from conftest import ROOT
from PIL import Image

import glidar

TOLERANCE_M = 5e-4  # documented accuracy: half a step of the depth image of 1 mm
WIDE = {"model": "radial_tangential", "k1": -0.2, "k2": 0.05, "p1": 0.001, "p2": -0.002, "k3": 0.01}
RATIONAL = dict(WIDE, k4=0.1, k5=-0.05, k6=0.02)
FISHEYE = {"model": "fisheye", "k1": 0.02, "k2": -0.01, "k3": 0.004, "k4": -0.001}


def scene():
    result = glidar.Scene()
    result.add_model("builtin:asteroid", name="rock", id=300, class_name="rock", pose=glidar.pose([0, 0, 4]))
    result.add_model("builtin:box", name="wall", id=2, class_name="wall", scale=2.0, pose=glidar.pose([0.5, 0, 8]))
    return result


def frame_of(camera):
    return glidar.simulate(scene(), camera, pose=np.eye(4), columns="all")


def saved(frame, path, **options):
    frame.save(path, **options)
    return json.loads((path.parent / (path.name.partition(".")[0] + ".glidar.json")).read_text())


@pytest.mark.parametrize("centre", [0.0, 0.5])
def test_open3d_reconstructs_the_points_of_a_depth_image(tmp_path, centre):
    sensor = glidar.Sensor.from_dict(
        {"optics": {"type": "pinhole", "width": 64, "height": 48, "fx": 60, "fy": 61, "cx": 31.25, "cy": 22.5,
                    "pixel_centre": centre}}  # fmt: skip
    )
    frame = frame_of(sensor)
    sidecar = saved(frame, tmp_path / "a.depth.png", depth_units_per_m=2000.0)
    info = sidecar["sensor"]["camera_info"]
    k = np.reshape(info["k"], (3, 3))
    assert np.array_equal(k, sensor.K) and k[0, 2] == 31.25 - centre
    intrinsics = o3d.camera.PinholeCameraIntrinsic(info["width"], info["height"], k)
    image = o3d.io.read_image(str(tmp_path / "a.depth.png"))
    cloud = o3d.geometry.PointCloud.create_from_depth_image(
        image, intrinsics, depth_scale=sidecar["files"][0]["image"]["units_per_m"], depth_trunc=1e3
    )
    wanted = frame.cloud(["xyz"], drop_invalid=True)["xyz"].reshape(-1, 3)
    found = np.asarray(cloud.points)
    assert len(found) == len(wanted) > 500
    np.testing.assert_allclose(found, wanted, atol=TOLERANCE_M)


@pytest.mark.parametrize("distortion", [None, WIDE, RATIONAL, FISHEYE])
def test_opencv_reconstructs_the_points_of_a_distorted_depth_image(tmp_path, distortion):
    sensor = glidar.camera(64, 48, fx=55.0, fy=56.0, cx=33.0, cy=23.5, distortion=distortion)
    frame = frame_of(sensor)
    sidecar = saved(frame, tmp_path / "a.depth.tiff")
    info = sidecar["sensor"]["camera_info"]
    k, d = np.reshape(info["k"], (3, 3)), np.array(info["d"])
    assert np.array_equal(d, sensor.distortion) and info["distortion_model"] == sensor.distortion_model
    depth = cv2.imread(str(tmp_path / "a.depth.tiff"), cv2.IMREAD_UNCHANGED)
    assert depth.dtype == np.float32 and depth.shape == (48, 64)
    rows, cols = np.nonzero(~np.isnan(depth))
    pixels = np.stack([cols, rows], 1).astype(np.float64)[:, None]
    if info["distortion_model"] == "equidistant":
        plane = cv2.fisheye.undistortPoints(pixels, k, d)
    else:
        # the default of five iterations is too coarse for strong distortion
        criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-12)
        plane = cv2.undistortPoints(pixels, k, d, criteria=criteria)
    z = depth[rows, cols].astype(np.float64)
    found = np.column_stack([plane[:, 0] * z[:, None], z])
    wanted = frame.cloud(["xyz"])["xyz"][rows, cols]
    assert len(found) > 500
    np.testing.assert_allclose(found, wanted, atol=TOLERANCE_M)


def room():
    """Something in front of every pixel of a wide lens."""
    result = scene()
    result.add_model("builtin:plane", name="floor", scale=50.0, pose=glidar.look_at([0, 0, 1.2], [0, 0.1, 0], [0, 1, 0]))
    return result


def documented():
    """The points that the example of docs/files/images.md finds in a.depth.tiff."""
    text = (ROOT / "docs/files/images.md").read_text(encoding="utf-8")
    (block,) = (found for found in re.findall(r"```python\n(.*?)```", text, re.DOTALL) if "import cv2" in found)
    names = {}
    exec(compile(block, "docs/files/images.md", "exec"), names)
    return names["points"]


CAMERAS = {
    **{name: lambda name=name: glidar.load_sensor(name) for name in ("D435", "Azure-Kinect-NFOV", "Azure-Kinect-WFOV", "Kinect-v2")},
    "fisheye": lambda: glidar.camera(320, 240, fx=160.0, distortion=FISHEYE),
    "none": lambda: glidar.camera(320, 240),
}


@pytest.mark.parametrize("name", CAMERAS)
def test_the_documented_example_reconstructs_the_points_of_a_depth_image(tmp_path, monkeypatch, name):
    frame = glidar.simulate(room(), CAMERAS[name](), pose=np.eye(4))
    frame.save(tmp_path / "a.depth.tiff")
    monkeypatch.chdir(tmp_path)
    found = documented()
    wanted = frame.cloud(["xyz"], drop_invalid=True)["xyz"]
    assert len(found) == len(wanted) > 10_000
    np.testing.assert_allclose(found, wanted, atol=TOLERANCE_M)


def test_a_depth_tiff_contains_the_floats_of_the_npy(tmp_path):
    frame = frame_of(glidar.camera(32, 24, fov_deg=100.0))
    frame.save(tmp_path / "a.depth.tiff")
    frame.save(tmp_path / "a.npy")
    wanted = np.load(tmp_path / "a.npy")
    assert np.isnan(wanted).any() and not np.isnan(wanted).all()
    np.testing.assert_array_equal(np.asarray(Image.open(tmp_path / "a.depth.tiff")), wanted)
    np.testing.assert_array_equal(cv2.imread(str(tmp_path / "a.depth.tiff"), cv2.IMREAD_UNCHANGED), wanted)


def test_ground_truth_images_contain_the_columns_of_the_cloud(tmp_path):
    frame = frame_of(glidar.camera(40, 30, fov_deg=100.0))
    cloud = frame.cloud("all")
    read = {}
    for name in ("rgb", "normal", "instance", "class"):
        frame.save(tmp_path / f"a.{name}.png")
        read[name] = cv2.imread(str(tmp_path / f"a.{name}.png"), cv2.IMREAD_UNCHANGED)
    none = cloud["instance"] == 0xFFFFFFFF
    assert none.any() and not none.all()
    assert read["instance"].dtype == np.uint16 and read["class"].dtype == np.uint8
    np.testing.assert_array_equal(read["instance"], np.where(none, 0, cloud["instance"]))
    np.testing.assert_array_equal(read["class"], np.where(none, 0, cloud["class"]))
    assert set(np.unique(read["instance"])) == {0, 2, 300}
    normal = read["normal"][:, :, ::-1]  # OpenCV's channel order is blue, green, red
    assert normal.dtype == np.uint16 and not normal[none].any()
    half_step = 1.0 / 65535
    np.testing.assert_allclose(normal[~none] * (2 / 65535) - 1, cloud["normal"][~none], atol=1.01 * half_step)
    rgb = read["rgb"][:, :, ::-1]
    lit = cloud["colour"] * np.cos(cloud["incidence"].astype(np.float64))[:, :, None]
    assert not rgb[none].any()
    np.testing.assert_allclose(rgb[~none], 255 * lit[~none], atol=0.501)


def test_only_cameras_have_intrinsics():
    with pytest.raises(glidar.Error, match="not a camera"):
        _ = glidar.load_sensor("VLP-16").K
