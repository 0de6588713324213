# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Depths of frames, clouds as files, and scenes of many instances."""

import json
import pickle

import numpy as np
import pytest

import glidar


@pytest.fixture(scope="module")
def frame():
    pose = glidar.look_at([4, 1, 1], [0, 0, 0])
    return glidar.simulate(glidar.Scene("builtin:box"), glidar.camera(32, 24, fov_deg=50.0), pose=pose, columns="all")


def test_depths_of_a_camera_are_along_its_boresight(frame):
    depth = frame.depth_m
    np.testing.assert_array_equal(depth, frame.cloud(["xyz"])["xyz"][..., 2])
    assert np.nanmax(depth) < np.nanmax(frame.range_m) and not depth.flags.writeable


def test_lidars_have_no_depths():
    with pytest.raises(glidar.Error, match="use range_m"):
        _ = glidar.simulate(glidar.Scene("builtin:box"), "VLP-16", pose=glidar.pose([0, 0, 0])).depth_m


@pytest.mark.parametrize("suffix", [".pcd", ".ply", ".csv"])
def test_a_cloud_is_saved_with_the_bytes_of_its_frame(frame, tmp_path, suffix):
    columns = ["xyz", "intensity", "range", "instance"]
    frame.cloud(columns).save(tmp_path / f"cloud{suffix}")
    frame.save(tmp_path / f"frame{suffix}", columns=columns, sidecar=False)
    assert (tmp_path / f"cloud{suffix}").read_bytes() == (tmp_path / f"frame{suffix}").read_bytes()
    assert len(list(tmp_path.iterdir())) == 2  # no sidecar


def test_changed_and_unpickled_clouds_are_saved_as_they_are(frame, tmp_path):
    cloud = pickle.loads(pickle.dumps(frame.cloud(["xyz", "intensity"], drop_invalid=True)))
    cloud["xyz"][:] += 100.0
    cloud.save(tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as saved:
        np.testing.assert_array_equal(saved["xyz"].reshape(-1, 3), cloud["xyz"])


@pytest.mark.parametrize("suffix", [".depth.png", ".las", ".bin", ".kitti"])
def test_files_that_need_more_than_the_cloud_are_refused(frame, tmp_path, suffix):
    with pytest.raises(glidar.Error, match=f"allowed: .pcd .ply .npz .csv .exr; write {suffix} of a frame with Frame.save"):
        frame.cloud("all").save(tmp_path / f"a{suffix}")
    assert not list(tmp_path.iterdir())


def test_an_image_of_a_camera_that_looks_back_needs_ranges(tmp_path):
    fisheye = {"type": "pinhole", "width": 32, "height": 32, "fx": 8.0, "fy": 8.0, "cx": 16.0, "cy": 16.0,
               "distortion": {"model": "fisheye"}}  # fmt: skip
    measured = glidar.simulate(glidar.Scene("builtin:box"), glidar.Sensor.from_dict({"optics": fisheye}), pose=np.eye(4))
    with pytest.raises(glidar.Error, match="request range too"):
        measured.cloud(["xyz", "depth"]).save(tmp_path / "a.exr")
    measured.cloud(["xyz", "depth", "range"]).save(tmp_path / "a.exr")


def test_a_sidecar_lists_the_files_of_one_measurement_that_exist(tmp_path):
    scene, camera = glidar.Scene("builtin:box"), glidar.camera(8, 6, fov_deg=50.0)
    first, second = (glidar.simulate(scene, camera, pose=np.eye(4), start_ns=start_ns) for start_ns in (0, 5))
    listed = lambda: [one["file"] for one in json.loads((tmp_path / "x.glidar.json").read_text())["files"]]
    for frame, suffix, files in ((first, ".ply", ["x.ply"]), (second, ".pcd", ["x.pcd"]), (second, ".npz", ["x.npz", "x.pcd"])):
        frame.save(tmp_path / f"x{suffix}")
        assert listed() == files
    (tmp_path / "x.npz").unlink()
    second.save(tmp_path / "x.pcd")
    assert listed() == ["x.pcd"]


def test_a_file_of_poses_places_many_instances(tmp_path):
    places = np.random.default_rng(1).uniform(-500, 500, (1000, 2)).round(3)
    rows = "".join(f"{x},{y},0,{k % 360}\n" for k, (x, y) in enumerate(places.tolist()))
    (tmp_path / "trees.csv").write_text("x,y,z,yaw_deg\n" + rows)
    (tmp_path / "scene.yaml").write_text(
        "models:\n  - {model: builtin:box, name: tree, class: tree, poses: trees.csv, pose: {position: [0, 0, 1]}}\n"
        "  - {model: builtin:sphere}\n")  # fmt: skip
    scene = glidar.Scene(tmp_path / "scene.yaml")
    objects = scene.objects
    assert [objects[k].name for k in (0, 1, 999, 1000)] == ["tree", "tree_2", "tree_1000", "sphere"]
    assert len({one.id for one in objects}) == 1001 and objects[5].class_name == "tree"
    np.testing.assert_allclose([one.pose[:3, 3] for one in objects[:1000]], np.column_stack([places, np.ones(1000)]))
    np.testing.assert_allclose(objects[90].pose[:3, :3], [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-15)
    assert pickle.loads(pickle.dumps(scene)) == scene


@pytest.mark.parametrize("rows, found", [("1 2\n", "2 columns"), ("1 2 3\n1 2\n", "s.txt:2:"), ("", "no pose"), ("1 2 x\n", "'x'"),
                                         ("0 0 0 0 0 0 0\n", "s.txt:1:")])
def test_errors_of_poses_name_the_line(tmp_path, rows, found):
    (tmp_path / "s.txt").write_text(rows)
    (tmp_path / "scene.yaml").write_text("models: [{model: builtin:box, poses: s.txt}]\n")
    with pytest.raises(glidar.Error, match=found):
        glidar.Scene(tmp_path / "scene.yaml")


def test_poses_of_moving_objects_are_refused(tmp_path):
    (tmp_path / "s.txt").write_text("1 2 3\n")
    (tmp_path / "scene.yaml").write_text("models: [{model: builtin:box, poses: s.txt, motion: {twist: {velocity_m_s: [1, 0, 0]}}}]\n")
    with pytest.raises(glidar.Error, match="given beside 'motion'"):
        glidar.Scene(tmp_path / "scene.yaml")
