# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""OpenEXR images, read by the OpenEXR project's own Python package."""

import json

import numpy as np
import pytest

import glidar

OpenEXR = pytest.importorskip("OpenEXR")

KNOWN = {"depth": ["Z"], "xyz": ["P.X", "P.Y", "P.Z"], "normal": ["N.X", "N.Y", "N.Z"],
         "shading_normal": ["Ns.X", "Ns.Y", "Ns.Z"], "colour": ["R", "G", "B"]}  # fmt: skip


@pytest.fixture(autouse=True)
def has_openexr(program):
    if "OpenEXR" not in program("--version"):
        pytest.skip("this build has no OpenEXR; install libopenexr-dev and build again")


@pytest.fixture
def frame():
    scene = glidar.Scene()
    scene.add_model("builtin:asteroid", name="rock", id=300, class_name="rock", pose=glidar.pose([0, 0, 4]))
    scene.add_model("builtin:box", name="wall", id=2, class_name="wall", scale=2.0, pose=glidar.pose([0.5, 0, 8]))
    return glidar.simulate(scene, glidar.camera(40, 37, fov_deg=100.0), pose=np.eye(4), columns="all")


def read(path):
    """(channels as arrays by name, attributes) of the only part."""
    (part,) = OpenEXR.File(str(path), separate_channels=True).parts
    return {name: channel.pixels for name, channel in part.channels.items()}, part.header


def channels_of(column, shape):
    """The names of the components of a column, from the sidecar."""
    names = column["components"]
    assert len(names) == (shape[2] if len(shape) > 2 else 1)
    return names


def check_channels(images, cloud, columns):
    seen = set()
    for column in columns:
        values = cloud[column["name"]]
        wanted_type = np.uint32 if values.dtype.kind == "u" else np.float32
        planes = values.reshape(*values.shape[:2], -1).astype(wanted_type)
        for k, channel in enumerate(channels_of(column, values.shape)):
            assert images[channel].dtype == wanted_type, channel
            np.testing.assert_array_equal(images[channel], planes[:, :, k], channel)
            seen.add(channel)
        assert column["name"] not in KNOWN or column["components"] == KNOWN[column["name"]]
        assert column["type"] == ("u32" if wanted_type is np.uint32 else "f32")
    assert seen == set(images)


def test_channels_contain_the_columns_of_the_cloud(frame, tmp_path):
    frame.save(tmp_path / "a.exr", columns="all")
    images, header = read(tmp_path / "a.exr")
    sidecar = json.loads((tmp_path / "a.glidar.json").read_text())
    columns = sidecar["files"][0]["columns"]
    cloud = frame.cloud("all")
    check_channels(images, cloud, columns)
    # OpenEXR has no 64-bit integers
    assert {column["name"] for column in columns} == {*cloud} - {"stamp"}
    miss = cloud["instance"] == 0xFFFFFFFF
    assert miss.any() and not miss.all()
    assert np.isnan(images["Z"][miss]).all() and (images["instance"][miss] == 0xFFFFFFFF).all()
    assert set(np.unique(images["instance"][~miss])) == {2, 300}
    assert header["comments"] == sidecar["files"][0]["image"]["pixels"]
    assert header["compression"] == OpenEXR.ZIP_COMPRESSION
    assert header["software"].startswith("glidar ")


def test_depth_is_always_a_channel_and_other_columns_are_selected(frame, tmp_path):
    frame.save(tmp_path / "a.exr", columns=["instance", "normal"])
    images, _ = read(tmp_path / "a.exr")
    assert set(images) == {"Z", "N.X", "N.Y", "N.Z", "instance"}
    frame.save(tmp_path / "b.exr")
    defaults = {"xyz", "intensity", "range", "normal", "instance", "class", "depth"}
    columns = json.loads((tmp_path / "b.glidar.json").read_text())["files"][0]["columns"]
    assert {column["name"] for column in columns} == defaults
    check_channels(read(tmp_path / "b.exr")[0], frame.cloud(sorted(defaults)), columns)


def test_normals_are_in_the_requested_coordinate_frame(frame, tmp_path):
    frame.save(tmp_path / "a.exr", columns=["normal"], frame="ros")
    images, _ = read(tmp_path / "a.exr")
    wanted = frame.cloud(["normal"], frame="ros")["normal"]
    np.testing.assert_array_equal(np.stack([images[f"N.{k}"] for k in "XYZ"], 2), wanted)


def test_a_scanner_has_a_row_for_each_ring_and_its_misses_stay(tmp_path):
    scene = glidar.Scene()
    scene.add_model("builtin:box", scale=4.0, pose=glidar.pose([6, 0, 0]))
    frame = glidar.simulate(scene, glidar.load_sensor("VLP-16"), pose=np.eye(4), columns="all")
    frame.save(tmp_path / "a.exr", columns=["range", "ring"], drop_invalid=True)
    images, _ = read(tmp_path / "a.exr")
    cloud = frame.cloud(["range", "ring"])
    np.testing.assert_array_equal(images["range"], cloud["range"].astype(np.float32))
    np.testing.assert_array_equal(images["ring"], cloud["ring"])
    assert images["ring"].shape[0] == 16 and np.isnan(images["range"]).any()


def test_the_same_frame_gives_the_same_bytes(frame, tmp_path):
    for name in ("a.exr", "b.exr"):
        frame.save(tmp_path / name, columns="all")
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()


def test_render_writes_numbered_images(program, tmp_path):
    options = ["builtin:box", "-w", 20, "--height", 10, "--duration", 0.1, "-o", tmp_path / "a.exr"]
    program("render", *options)
    found = sorted(path.name for path in tmp_path.glob("*.exr"))
    assert found[0] == "a_000000.exr" and len(found) > 1
    assert set(read(tmp_path / found[-1])[0]) > {"Z", "P.X", "N.X", "instance"}
