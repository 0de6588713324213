# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Files are byte-identical to those of the command line."""

import json
import re

import numpy as np
import pytest

import glidar


@pytest.fixture(scope="module")
def scene_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "scene.yaml"
    path.write_text(
        "models:\n  - {model: 'builtin:asteroid', id: 5, class: rock}\n  - {model: 'builtin:box', pose: {position: [2, 1, 0]}}\n"
        "sensor:\n  optics: {type: pinhole, width: 60, height: 40, fov_deg: 40}\n"
        "  noise: [{type: range_gaussian, sigma_m: 0.01}, {type: dropout, probability: 0.05}]\n"
        "sensor_pose: {look_at: {eye: [6, -4, 3], target: [0, 0, 0]}}\n"
    )
    return path


CASES = {
    "a.pcd": ({}, []),
    "ascii.pcd": ({"pcd": "ascii", "columns": "all"}, ["--pcd-encoding", "ascii", "--columns", "all"]),
    "small.pcd": ({"pcd": "binary_compressed"}, ["--pcd-encoding", "binary_compressed"]),
    "dense.pcd": ({"drop_invalid": True, "frame": "world"}, ["--drop-invalid", "--frame", "world"]),
    "layout.pcd": ({"layout": "velodyne", "drop_invalid": True}, ["--layout", "velodyne", "--drop-invalid"]),
    "b.ply": ({"frame": "ros"}, ["--frame", "ros"]),
    "ascii.ply": ({"ply_ascii": True, "deskew": True}, ["--ply-ascii", "--deskew"]),
    "c.npz": ({"columns": "all"}, ["--columns", "all"]),
    "d.csv": ({"columns": ["xyz", "status"]}, ["--columns", "xyz,status"]),
    "e.bin": ({}, []),
    "f.npy": ({}, []),
    "g.depth.png": ({"depth_units_per_m": 5000.0}, ["--depth-scale", "5000"]),
    "g.depth.tiff": ({}, []),
    "g.rgb.png": ({}, []),
    "g.normal.png": ({}, []),
    "g.instance.png": ({}, []),
    "g.class.png": ({}, []),
    "g.exr": ({"columns": "all"}, ["--columns", "all"]),
    "h.png": ({}, []),
    "i.transform": ({}, []),
}


@pytest.mark.parametrize("name", CASES)
def test_file_is_byte_identical_to_that_of_the_command_line(name, scene_file, tmp_path, program):
    if name.endswith(".exr") and "OpenEXR" not in program("--version"):
        pytest.skip("this build has no OpenEXR; install libopenexr-dev and build again")
    arguments, options = CASES[name]
    theirs, ours = tmp_path / "theirs", tmp_path / "ours"
    theirs.mkdir()
    ours.mkdir()
    program("render", scene_file, "--seed", 77, "-o", theirs / name, *options)
    frame = glidar.simulate(glidar.Scene(scene_file), seed=77, columns="all")
    frame.save(ours / name, **arguments)
    assert (ours / name).read_bytes() == (theirs / name).read_bytes()
    sidecars = [folder / f"{name.partition('.')[0]}.glidar.json" for folder in (ours, theirs)]
    assert sidecars[0].exists() == sidecars[1].exists()
    if sidecars[0].exists():
        mine, theirs = (json.loads(path.read_text()) for path in sidecars)
        assert theirs.pop("command")
        mine.pop("command")
        assert mine == theirs


def test_file_of_a_preset_is_byte_identical_to_that_of_the_command_line(tmp_path, program):
    program("render", "builtin:asteroid", "--sensor", "VLP-16", "--seed", 3, "-o", tmp_path / "theirs.npz")
    glidar.simulate(glidar.Scene("builtin:asteroid"), "VLP-16", seed=3).save(tmp_path / "ours.npz")
    assert (tmp_path / "ours.npz").read_bytes() == (tmp_path / "theirs.npz").read_bytes()


def test_fisher_information_is_byte_identical_to_that_of_the_command_line(scene_file, tmp_path, program):
    program("render", scene_file, "--fisher", "-o", tmp_path / "a.pcd")
    information = glidar.simulate(glidar.Scene(scene_file)).fisher_information()
    information.save(tmp_path / "ours.json")
    assert (tmp_path / "ours.json").read_bytes() == (tmp_path / "a.fisher.json").read_bytes()


def test_trace_text_is_identical_to_that_of_the_command_line(scene_file, tmp_path, program):
    program("render", scene_file, "--seed", 4, "-o", tmp_path / "a.pcd")
    printed = program("explain", tmp_path / "a.pcd", "--index", 1234)
    assert str(glidar.simulate(glidar.Scene(scene_file), seed=4).explain(1234)) == printed


def test_npz_contains_the_columns_of_the_cloud(scene_file, tmp_path):
    frame = glidar.simulate(glidar.Scene(scene_file))
    frame.save(tmp_path / "a.npz")
    cloud = frame.cloud()
    with np.load(tmp_path / "a.npz") as read:
        for name in cloud:
            assert np.array_equal(read[name], cloud[name], equal_nan=True), name


def test_failed_saves_leave_no_files(scene_file, tmp_path):
    frame = glidar.simulate(glidar.Scene(scene_file))
    for arguments, words in [
        ({"path": tmp_path / "a.pdc"}, "did you mean .pcd?"),
        ({"path": tmp_path / "none" / "a.pcd"}, "there is no folder"),
        ({"path": tmp_path / "a.pcd", "layout": "velodine"}, "velodyne"),
        ({"path": tmp_path / "a.pcd", "layout": "velodyne", "columns": "all"}, "both are given"),
        ({"path": tmp_path / "a.pcd", "columns": ["colour"]}, "colour"),
        ({"path": tmp_path / "a.pcd", "pcd": "text"}, "pcd: 'text'"),
        ({"path": tmp_path / "a.depth.png", "depth_units_per_m": -1}, "depth_units_per_m: -1"),
        ({"path": tmp_path / "a.pcd", "frame": "up"}, "coordinate frame: 'up'"),
    ]:
        with pytest.raises(glidar.Error) as caught:
            frame.save(**arguments)
        assert words in str(caught.value), str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_input_files_are_not_overwritten(tmp_path):
    model = tmp_path / "m.ply"
    trimesh = pytest.importorskip("trimesh")
    trimesh.creation.box().export(model)
    before = model.read_bytes()
    (tmp_path / "s.yaml").write_text("models: [{model: m.ply}]")
    for source in (model, tmp_path / "s.yaml"):
        frame = glidar.simulate(glidar.Scene(source), glidar.camera(16, 16))
        with pytest.raises(glidar.Error, match="is an input file"):
            frame.save(model)
        with pytest.raises(glidar.Error, match="is an input file"):
            frame.save(tmp_path / ".." / tmp_path.name / "m.ply")
    assert model.read_bytes() == before


SUFFIX = re.compile(r"(?<![\w.])\.[a-z_]+[0-9]?(?:\.[a-z]+)*")


def test_errors_list_every_suffix(scene_file, tmp_path):
    frame = glidar.simulate(glidar.load_scene(scene_file))
    with pytest.raises(glidar.Error) as caught:
        frame.save(tmp_path / "a.unknown")
    allowed = set(SUFFIX.findall(str(caught.value).split("allowed:")[1]))
    needs_openexr = {".exr"}
    assert set(glidar.output_formats()) - needs_openexr == allowed - needs_openexr
