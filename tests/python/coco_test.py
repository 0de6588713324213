# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""COCO data sets, read by pycocotools if it is installed and always by a reader of their definition."""

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
