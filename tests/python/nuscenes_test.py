# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""nuScenes data sets, read and rendered by nuscenes-devkit."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

import glidar
from glidar.nuscenes import NuscenesWriter, main

ROOT = Path(__file__).resolve().parents[2]
READER_PYTHON = ROOT / "build/venv-datasets/bin/python"
sys.path.insert(0, str(ROOT / "tests" / "support"))
from waiting import MAX_WAIT_S  # noqa: E402

SCENE = """models:
  - {model: 'builtin:box:size=80,12,0.1', name: ground, class: road, pose: {position: [20, 0, -0.05]}}
  - {model: 'builtin:box:size=60,0.5,5', name: house, class: building, pose: {position: [20, 7, 2.5]}}
  - {model: 'builtin:box:size=4,1.8,1.5', name: parked, class: car, pose: {position: [12, 3, 0.8], euler_deg: {yaw: 10}}}
  - model: 'builtin:box:size=4,1.8,1.5'
    name: ahead
    class: car
    pose: {position: [9, -1, 0.8]}
    motion: {twist: {velocity_m_s: [4, 0, 0]}}
  - {model: 'builtin:box:size=0.5,0.5,1.7', name: walker, class: person, pose: {position: [8, -4, 0.9]}}
  - {model: 'builtin:box:size=0.5,0.5,1.7', name: unseen, class: person, pose: {position: [30, 20, 0.9]}}
sensors:
  - {name: lidar, sensor: VLP-16, pose: {position: [0, 0, 1.9]}}
  - name: camera
    sensor: {optics: {type: pinhole, width: 160, height: 90, fov_deg: 80}, rate_hz: 5}
    pose: {position: [0.5, 0, 1.6], euler_deg: {roll: -90, yaw: -90}}
rig_pose: {position: [-3, -1, 0]}
rig_motion: {twist: {velocity_m_s: [4, 0, 0]}}
"""


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "scene.yaml"
    path.write_text(SCENE)
    return path


@pytest.fixture(scope="module")
def data_set(scene, tmp_path_factory):
    root = tmp_path_factory.mktemp("data") / "nuscenes"
    with NuscenesWriter(root) as data:
        data.add_scene(glidar.Scene(scene), duration_s=1.2)
        data.add_scene(glidar.Scene(scene), duration_s=0.2, seed=2)
    return root


@pytest.fixture(scope="module")
def read(data_set, tmp_path_factory):
    """What the devkit finds."""
    if not READER_PYTHON.exists():
        pytest.skip("build/venv-datasets is missing; ./dev makes it")
    pictures = tmp_path_factory.mktemp("pictures")
    done = subprocess.run([READER_PYTHON, "-B", ROOT / "tests/python/readers/nuscenes_reader.py", data_set, pictures],
                          capture_output=True, text=True, timeout=MAX_WAIT_S, check=False)  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert len(list(pictures.glob("*.png"))) == 5
    return json.loads(done.stdout)


def test_the_devkit_reads_and_renders_every_scan(read):
    assert [key["channels"] for key in read["keys"]] == [["CAM_FRONT", "LIDAR_TOP"]] * 4
    assert [scan["key"] for scan in read["scans"]].count(True) == 4
    assert len(read["scans"]) == 12 + 2
    for scan in read["scans"]:
        assert scan["points"] > 1000 and scan["rings"] == 16
        assert scan["intensity"][0] >= 0.0 and 10.0 < scan["intensity"][1] <= 255.0
    assert read["sweeps"] > 2 * read["scans"][0]["points"]


def test_boxes_contain_the_points_that_they_list(read):
    names = {one["category"] for key in read["keys"] for one in key["annotations"]}
    assert names == {"vehicle.car", "human.pedestrian.adult"}, "the road and the house have no boxes"
    for key in read["keys"]:
        assert len(key["annotations"]) == 3, "the person behind the house has no points"
        for one in key["annotations"]:
            # ranges have noise, the ground is near, and the car ahead moves by up to 0.4 m while the beams are fired
            assert 0.5 * one["listed"] <= one["inside"] <= 2.0 * one["listed"]


def test_attributes_velocities_and_visibility_follow_the_motion(read):
    for one in read["keys"][1]["annotations"]:
        if one["attributes"] == ["vehicle.moving"]:
            assert abs(one["velocity"][0] - 4.0) < 1e-6
        else:
            assert max(abs(part) for part in one["velocity"]) < 1e-6
            assert one["attributes"] in (["vehicle.parked"], ["pedestrian.standing"])
        assert one["visibility"] in ("v0-40", "v40-60", "v60-80", "v80-100")
    assert any(one["visibility"] == "v80-100" for one in read["keys"][0]["annotations"])


def test_the_same_seed_gives_the_same_bytes(scene, data_set, tmp_path):
    with NuscenesWriter(tmp_path / "again") as data:
        data.add_scene(glidar.Scene(scene), duration_s=1.2, threads=1)
        data.add_scene(glidar.Scene(scene), duration_s=0.2, seed=2)
    names = sorted(path.relative_to(data_set) for path in data_set.rglob("*") if path.is_file())
    assert names == sorted(path.relative_to(tmp_path / "again") for path in (tmp_path / "again").rglob("*") if path.is_file())
    for name in names:
        assert (data_set / name).read_bytes() == (tmp_path / "again" / name).read_bytes(), name


def test_visibility_is_a_fraction_of_the_pixels_of_all_images(scene, data_set):
    """The parked car of the first sample, as the camera of the rig sees it."""
    frame = glidar.simulate_rig(glidar.Scene(scene))["camera"]
    box = next(box for box in frame.boxes() if box.name == "parked")
    tables = {name: json.loads((data_set / "v1.0-mini" / f"{name}.json").read_text()) for name in ("sample_annotation", "sample")}
    first = tables["sample"][0]["token"]
    parked = [one for one in tables["sample_annotation"] if one["sample_token"] == first and abs(one["size"][1] - 4.0) < 1e-6]
    levels = {one["visibility_token"] for one in parked}
    assert str(1 + sum(1.0 - box.occlusion >= least for least in (0.4, 0.6, 0.8))) in levels


def test_the_command_line_writes_a_data_set(scene, tmp_path, capsys):
    assert main([str(scene), "-o", str(tmp_path / "out"), "--duration", "0.1", "--category", "person=animal"]) == 0
    assert "wrote" in capsys.readouterr().out
    names = {one["name"] for one in json.loads((tmp_path / "out/v1.0-mini/category.json").read_text())}
    assert "animal" in names and "human.pedestrian.adult" not in names
    assert main([str(scene), "-o", str(tmp_path / "out"), "--duration", "0.1"]) == 2
    assert "empty" in capsys.readouterr().err


def test_a_category_of_a_class_that_no_scene_has_is_refused(scene, tmp_path, capsys):
    assert main([str(scene), "-o", str(tmp_path / "out"), "--duration", "0.1", "--category", "persn=animal"]) == 2
    error = capsys.readouterr().err
    assert "--category" in error and "persn" in error and "person" in error
    assert not (tmp_path / "out").exists()


def test_classes_that_the_devkit_does_not_know_have_no_lidarseg(scene, tmp_path):
    with NuscenesWriter(tmp_path / "out", categories={"car": "spaceship"}) as data:
        data.add_scene(glidar.Scene(scene), duration_s=0.1)
    assert not (tmp_path / "out/v1.0-mini/lidarseg.json").exists()


def test_errors_name_what_is_missing(scene, tmp_path):
    with pytest.raises(glidar.Error, match="LIDAR_TOP"), NuscenesWriter(tmp_path / "a") as data:
        text = SCENE.replace("{name: lidar, sensor: VLP-16, pose: {position: [0, 0, 1.9]}}",
                             "{name: other, sensor: {optics: {type: pinhole, width: 8, height: 8, fov_deg: 60}}}")  # fmt: skip
        (tmp_path / "cameras.yaml").write_text(text)
        data.add_scene(glidar.Scene(tmp_path / "cameras.yaml"), duration_s=0.1)
    data = NuscenesWriter(tmp_path / "b")
    with pytest.raises(glidar.Error, match="no scene"):
        data.close()
    with pytest.raises(glidar.Error, match="duration_s"):
        data.add_scene(glidar.Scene(scene), duration_s=0.0)
    with pytest.raises(glidar.Error, match="channels"):
        data.add_scene(glidar.Scene(scene), duration_s=0.1, channels={"radar": "RADAR_FRONT"})
    data.add_scene(glidar.Scene(scene), duration_s=0.1, name="one")
    with pytest.raises(glidar.Error, match="name"):
        data.add_scene(glidar.Scene(scene), duration_s=0.1, name="one")


def test_nothing_remains_of_a_data_set_that_ends_by_an_exception(scene, tmp_path, monkeypatch, capsys):
    def interrupt(*_, **__):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr("glidar._nuscenes_scene.SceneWriter.write", interrupt)
        assert main([str(scene), "-o", str(tmp_path / "data"), "--duration", "0.2"]) == 130
    assert "interrupted" in capsys.readouterr().err
    assert main([str(tmp_path / "none.yaml"), "-o", str(tmp_path / "data")]) == 2
    assert list(tmp_path.iterdir()) == []


def test_an_empty_folder_is_filled_and_one_that_was_filled_meanwhile_is_kept(scene, tmp_path):
    for name in ("empty", "filled"):
        (tmp_path / name).mkdir()
    assert main([str(scene), "-o", str(tmp_path / "empty"), "--duration", "0.05"]) == 0
    assert (tmp_path / "empty" / "v1.0-mini" / "scene.json").exists()
    with pytest.raises(glidar.Error, match="choose another name"), NuscenesWriter(tmp_path / "filled") as data:
        data.add_scene(glidar.Scene(scene), duration_s=0.05)
        (tmp_path / "filled" / "mine.txt").write_text("mine")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["empty", "filled"]
    assert [path.name for path in (tmp_path / "filled").iterdir()] == ["mine.txt"]
