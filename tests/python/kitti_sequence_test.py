# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""KITTI folders of a whole run, read by pykitti, KISS-ICP and the SemanticKITTI API."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import glidar

ROOT = Path(__file__).resolve().parents[2]
READERS = Path(__file__).parent / "readers"
sys.path.insert(0, str(ROOT / "tests" / "support"))
from waiting import MAX_WAIT_S  # noqa: E402

SCENE = """models:
  - {model: 'builtin:box:size=80,30,0.1', name: ground, class: road, pose: {position: [10, 0, -0.05]}}
  - {model: 'builtin:box:size=4,1.8,1.5', name: car, id: 7, class: parked car, pose: {position: [10, 1, 0.8], euler_deg: {yaw: 20}}}
  - {model: 'builtin:box:size=0.4,3,4', name: wall, id: 9, class: wall, pose: {position: [7, 1.8, 2]}}
  - {model: 'builtin:box:size=1,1,2', name: far, id: 11, class: pole, pose: {position: [30, -8, 1]}}
sensors:
  - {name: left, sensor: {optics: {type: pinhole, width: 120, height: 80, fov_deg: 80}, rate_hz: 20},
     pose: {position: [0.3, 0.2, 1.6], euler_deg: {roll: -90, yaw: -90}}}
  - {name: lidar, sensor: VLP-16, pose: {position: [0, 0, 1.8], euler_deg: {yaw: 5}}}
  - {name: right, sensor: {optics: {type: pinhole, width: 120, height: 80, fov_deg: 80}, rate_hz: 10},
     pose: {position: [0.3, -0.3, 1.6], euler_deg: {roll: -90, yaw: -90}}}
rig_pose: {position: [0, 0, 0]}
rig_motion: {twist: {velocity_m_s: [2, 0, 0], rate_deg_s: [0, 0, -30]}}
box_classes: [all]
"""
FRAMES = 3


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A KITTI data set whose sequence 00 is the folder of a run."""
    folder = tmp_path_factory.mktemp("kitti")
    (folder / "scene.yaml").write_text(SCENE)
    done = subprocess.run(["glidar", "render", "scene.yaml", "--duration", "0.3", "-o", "drive.kitti"], cwd=folder,
                          capture_output=True, text=True, timeout=MAX_WAIT_S, check=False)  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stdout == "wrote drive.kitti\n"
    (folder / "sequences").mkdir()
    (folder / "poses").mkdir()
    (folder / "sequences" / "00").symlink_to(folder / "drive.kitti")
    (folder / "poses" / "00.txt").symlink_to(folder / "drive.kitti" / "poses.txt")
    return folder


def read_by(environment, reader, folder):
    python = ROOT / "build" / environment / "bin/python"
    if not python.exists():
        pytest.skip(f"build/{environment} is missing; ./dev makes it")
    done = subprocess.run([python, "-B", READERS / reader, folder], capture_output=True, text=True, timeout=MAX_WAIT_S, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def rig_frames(folder, number=0):
    return glidar.simulate_rig(glidar.Scene(folder / "scene.yaml"), frame=number, columns="all")


def test_the_folder_has_all_files_of_each_scan(folder):
    drive = folder / "drive.kitti"
    for part, suffix in (("velodyne", "bin"), ("labels", "label"), ("calib", "txt"), ("label_2", "txt"), ("image_2", "png"), ("image_3", "png")):
        assert sorted(path.name for path in (drive / part).iterdir()) == [f"{k:06}.{suffix}" for k in range(FRAMES)], part
    for name in ("times.txt", "poses.txt", "calib.txt", "semantic-kitti.yaml"):
        assert (drive / name).is_file()


def test_pykitti_reads_scans_images_times_poses_and_calibration(folder):
    read = read_by("venv-datasets", "pykitti_reader.py", folder)
    assert read["frames"] == FRAMES
    np.testing.assert_allclose(read["times"], [0.0, 0.1, 0.2], atol=2e-6)
    assert min(read["scans"]) > 1000
    assert read["images"] == [[80, 120, 3]] * FRAMES
    scene = glidar.Scene(folder / "scene.yaml")
    left, lidar, right = (scene.rig[name] for name in ("left", "lidar", "right"))
    camera_from_lidar = np.linalg.inv(left.rig_from_sensor) @ lidar.rig_from_sensor
    np.testing.assert_allclose(read["cam0_from_velo"], camera_from_lidar, atol=1e-9)
    np.testing.assert_allclose(read["cam2_from_velo"], camera_from_lidar, atol=1e-9)
    np.testing.assert_allclose(read["K"], left.sensor.K, atol=1e-9)
    # image_3 is from a camera half a metre to the right
    np.testing.assert_allclose(read["P3"], right.sensor.K @ np.array([[1, 0, 0, -0.5], [0, 1, 0, 0], [0, 0, 1, 0]]), atol=1e-6)
    first = rig_frames(folder)["left"].world_from_sensor
    for number, pose in enumerate(read["poses"]):
        world_from_lidar = rig_frames(folder, number)["lidar"].world_from_sensor
        expected = np.linalg.inv(first) @ world_from_lidar @ np.linalg.inv(camera_from_lidar)
        np.testing.assert_allclose(pose, expected, atol=1e-9)


def test_image_2_is_the_last_image_that_starts_no_later_than_the_scan(folder, tmp_path):
    for scan, image in ((0, 0), (1, 2), (2, 4)):  # at 20 Hz
        rig_frames(folder, image)["left"].save(tmp_path / "a.rgb.png")
        ours = np.asarray(Image.open(folder / "drive.kitti" / "image_2" / f"{scan:06}.png"))
        np.testing.assert_array_equal(ours, np.asarray(Image.open(tmp_path / "a.rgb.png")))
        assert ours.any()


def test_kiss_icp_reads_the_sequence(folder):
    kitti = pytest.importorskip("kiss_icp.datasets.kitti")
    data = kitti.KITTIOdometryDataset(folder, "0")
    assert len(data) == FRAMES
    np.testing.assert_allclose(data.get_frames_timestamps().ravel(), [0.0, 0.1, 0.2], atol=1e-9)
    # its ground truth is of the LiDAR, relative to its first pose
    worlds = [rig_frames(folder, number)["lidar"].world_from_sensor for number in range(FRAMES)]
    expected = np.linalg.inv(worlds[0]) @ np.array(worlds)
    np.testing.assert_allclose(data.gt_poses, expected, atol=1e-5)  # it reads the calibration as float32


def test_the_semantic_kitti_api_reads_and_colours_the_labels(folder):
    read = read_by("venv-semantic-kitti", "semantic_kitti_reader.py", folder)
    assert len(read["scans"]) == FRAMES
    assert read["learned"] == {str(k): k for k in range(5)}
    for scan in read["scans"]:
        assert set(scan["classes"]) >= {"road", "parked car", "wall"}
        assert set(scan["instances"]) >= {1, 7, 9}
        assert scan["coloured"] == scan["points"], "every surface of the scene has a class"


def test_labels_are_of_the_left_camera_with_occlusion_by_the_lidar(folder):
    lines = [line.split() for line in (folder / "drive.kitti/label_2/000000.txt").read_text().splitlines()]
    states = {line[0]: int(line[2]) for line in lines}
    boxes = {box.class_name.replace(" ", "_"): box for box in rig_frames(folder)["lidar"].boxes()}
    for name, state in states.items():
        hidden = boxes[name].occlusion
        assert state == (0 if hidden <= 0.1 else 1 if hidden <= 0.5 else 2), name
    assert states["wall"] == 0 and states["parked_car"] > 0
    car = next(line for line in lines if line[0] == "parked_car")
    scene = glidar.Scene(folder / "scene.yaml")
    h, w, l, x, y, z = (float(word) for word in car[8:14])
    np.testing.assert_allclose([h, w, l], [1.5, 1.8, 4.0], atol=1e-5)
    camera_from_world = np.linalg.inv(rig_frames(folder)["left"].world_from_sensor)
    bottom = camera_from_world @ [*scene["car"].pose[:2, 3], 0.8 - 0.75, 1.0]
    np.testing.assert_allclose([x, y, z], bottom[:3], atol=1e-5)
    # the projected box covers the pixels of the car in the image of instances
    left = rig_frames(folder)["left"]
    rows, cols = np.nonzero(left.ground_truth.instance == scene["car"].index)
    u0, v0, u1, v1 = (float(word) for word in car[4:8])
    assert u0 <= cols.min() + 1e-3 and v0 <= rows.min() + 1e-3 and u1 >= cols.max() - 1e-3 and v1 >= rows.max() - 1e-3


def test_the_scans_are_those_of_a_folder_of_single_frames(folder, tmp_path):
    for number in range(FRAMES):
        rig_frames(folder, number)["lidar"].save(tmp_path / "single.kitti")
    for part in ("velodyne", "labels"):
        for number in range(FRAMES):
            name = f"{part}/{number:06}.{'bin' if part == 'velodyne' else 'label'}"
            assert (folder / "drive.kitti" / name).read_bytes() == (tmp_path / "single.kitti" / name).read_bytes()


def test_a_single_camera_is_the_scanner_and_the_camera(tmp_path, program):
    program("render", "builtin:asteroid", "--width", "40", "--height", "30", "--duration", "0.05", "-o", tmp_path / "a.kitti")
    drive = tmp_path / "a.kitti"
    images = sorted((drive / "image_2").iterdir())
    assert [path.stem for path in images] == [path.stem for path in sorted((drive / "velodyne").iterdir())]
    assert "Tr: 1.000000000000e+00 0.000000000000e+00" in (drive / "calib.txt").read_text()
    assert not (drive / "labels").exists() and not (drive / "semantic-kitti.yaml").exists()
    lidar = tmp_path / "b.kitti"
    program("render", "builtin:asteroid", "--sensor", "VLP-16", "--eye", "20,0,0", "-o", lidar)
    assert not (lidar / "image_2").exists() and (lidar / "poses.txt").read_text().count("\n") == 1


def test_scans_of_an_earlier_longer_run_are_reported(tmp_path, program):
    arguments = ("render", "builtin:box", "--sensor", "VLP-16", "--eye", "3,0,0", "-o", tmp_path / "a.kitti")
    program(*arguments, "--duration", "0.3")
    assert "000002.bin" in program(*arguments, "--duration", "0.2", code=2)
    assert (tmp_path / "a.kitti" / "times.txt").read_text().count("\n") == 2
