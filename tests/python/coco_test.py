# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""COCO data sets, read by pycocotools if it is installed and always by a reader of their definition."""

import gc
import json

import numpy as np
import pytest
from PIL import Image

import glidar
from glidar.coco import CocoWriter


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    folder = tmp_path_factory.mktemp("coco") / "set"
    scene = glidar.Scene.from_dict({"models": [
        {"model": "builtin:box", "name": "front", "class": "crate", "pose": {"position": [0, 0, 0]}},
        {"model": "builtin:sphere", "name": "ball", "class": "ball", "pose": {"position": [-3, 1, 0]}},
        {"model": "builtin:box:size=40,40,0.1", "name": "ground", "class": "road", "pose": {"position": [0, 0, -2]}},
    ]})
    sensor = glidar.camera(64, 48, fov_deg=60.0)
    poses = [glidar.look_at([7, y, 2], [0, 0, 0]) for y in (-1.0, 2.0)]
    with CocoWriter(folder, scene, sensor) as writer:
        assert [writer.add_image(pose) for pose in poses] == [1, 2]
    return folder, scene, sensor, poses


def decoded(segmentation):
    """Run lengths of zeros and ones, column by column."""
    values = np.repeat(np.arange(len(segmentation["counts"])) % 2, segmentation["counts"])
    return values.reshape(segmentation["size"], order="F").astype(bool)


def test_masks_boxes_and_categories_are_the_ground_truth(data):
    folder, scene, sensor, poses = data
    read = json.loads((folder / "annotations.json").read_text())
    names = {one["id"]: one["name"] for one in read["categories"]}
    assert names == {1: "crate", 2: "ball", 3: "road"}
    assert {names[one["category_id"]] for one in read["annotations"]} == {"crate", "ball"}  # no surfaces
    for number, pose in enumerate(poses, 1):
        instances = glidar.simulate(scene, sensor, pose=pose).ground_truth.instance
        found = [one for one in read["annotations"] if one["image_id"] == number]
        assert [one["name"] for one in found] == ["front", "ball"]
        for index, one in enumerate(found):
            mask = decoded(one["segmentation"])
            np.testing.assert_array_equal(mask, instances == index)
            rows, cols = np.nonzero(mask)
            assert one["bbox"] == [cols.min(), rows.min(), np.ptp(cols) + 1, np.ptp(rows) + 1]
            assert one["area"] == mask.sum() and 0.0 <= one["occlusion"] < 1.0


def test_colours_are_means_of_many_rays(data):
    folder, scene, sensor, poses = data
    image = np.asarray(Image.open(folder / "images" / "000001.png")).astype(int)
    assert image.shape == (48, 64, 3)
    frame = glidar.simulate(scene, sensor, pose=poses[0], columns="all")
    cloud = frame.cloud(["colour", "incidence"])
    single = np.nan_to_num(cloud["colour"] * np.cos(cloud["incidence"])[..., None]) * 255
    inside = np.zeros((48, 64), bool)
    instances = frame.ground_truth.instance
    same = lambda shift: instances == np.roll(instances, shift, (0, 1))
    inside[2:-2, 2:-2] = (same((1, 1)) & same((-1, -1)) & same((1, -1)) & same((-1, 1)))[2:-2, 2:-2]
    ground = inside & (instances == 2)
    assert ground.sum() > 200
    np.testing.assert_allclose(image[ground], single[ground], atol=4)
    edges = ~inside & (instances == 0)
    assert (np.abs(image[edges] - single[edges]).max(-1) > 8).any()  # mixed with what is behind


def test_pycocotools_reads_the_data_set(data):
    coco = pytest.importorskip("pycocotools.coco")
    folder, _, _, _ = data
    read = coco.COCO(str(folder / "annotations.json"))
    assert len(read.getImgIds()) == 2
    for one in read.loadAnns(read.getAnnIds()):
        mask = read.annToMask(one).astype(bool)
        np.testing.assert_array_equal(mask, decoded(one["segmentation"]))
        assert one["area"] == mask.sum()


def test_errors_name_what_is_missing(tmp_path):
    with pytest.raises(glidar.Error, match="no object has a class"):
        CocoWriter(tmp_path / "a", glidar.Scene("builtin:box"), glidar.camera(8, 6, fov_deg=40.0))
    scene = glidar.Scene.from_dict({"models": [{"model": "builtin:box", "class": "crate"}]})
    with pytest.raises(glidar.Error, match="a camera with a pinhole"):
        CocoWriter(tmp_path / "a", scene, "VLP-16")
    with pytest.raises(glidar.Error, match="it has no image"), CocoWriter(tmp_path / "a", scene, glidar.camera(8, 6, fov_deg=40.0)):
        pass
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def crate():
    return glidar.Scene.from_dict({"models": [{"model": "builtin:box", "class": "crate"}]})


CAMERA = glidar.camera(16, 12, fov_deg=50.0)


def test_images_measured_in_bands_of_rows_are_the_same(data, tmp_path, monkeypatch):
    folder, scene, sensor, poses = data
    monkeypatch.setattr(glidar.coco, "_MAX_RAYS", 64 * 16 * 5)  # 5 of 48 rows
    with CocoWriter(tmp_path / "set", scene, sensor) as writer:
        writer.add_image(poses[0])
    whole, banded = (np.asarray(Image.open(root / "images" / "000001.png")).astype(int) for root in (folder, tmp_path / "set"))
    assert banded.shape == whole.shape and np.abs(banded - whole).max() <= 1  # rays differ by rounding


def test_an_image_without_a_pose_has_that_of_its_masks(crate, tmp_path, monkeypatch):
    monkeypatch.setattr(glidar.coco, "_MAX_RAYS", 1)  # each row is a camera of its own
    with CocoWriter(tmp_path / "set", crate, CAMERA) as writer:
        writer.add_image()
        writer.add_image(glidar.simulate(crate, CAMERA).world_from_sensor)
    chosen, given = ((tmp_path / "set" / "images" / f"00000{k}.png").read_bytes() for k in (1, 2))
    assert chosen == given


def test_a_writer_closes_once(crate, tmp_path):
    writer = CocoWriter(tmp_path / "set", crate, CAMERA)
    writer.add_image()
    writer.close()
    before = sorted(tmp_path.rglob("*"))
    writer.close()
    with pytest.raises(glidar.Error, match="the writer is closed"):
        writer.add_image()
    assert sorted(tmp_path.rglob("*")) == before


def test_a_second_writer_of_a_folder_is_refused(crate, tmp_path):
    with CocoWriter(tmp_path / "set", crate, CAMERA) as writer:
        with pytest.raises(glidar.Error, match="another writer makes it"):
            CocoWriter(tmp_path / "set", crate, CAMERA)
        writer.add_image()
    assert [path.name for path in tmp_path.iterdir()] == ["set"]


@pytest.mark.parametrize("end", ["close", "exception", "nothing"])
def test_nothing_remains_of_a_data_set_that_fails(crate, tmp_path, end):
    writer = CocoWriter(tmp_path / "new" / "parents" / "set", crate, CAMERA)
    if end == "close":
        with pytest.raises(glidar.Error, match="it has no image"):
            writer.close()
    elif end == "exception":
        with pytest.raises(KeyError), writer:
            raise KeyError
    del writer
    gc.collect()
    assert list(tmp_path.iterdir()) == []
