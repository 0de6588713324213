# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Equality of scenes depends on their present contents only; rejected changes have no effect."""

import copy
import pickle

import numpy as np
import pytest
from conftest import ROOT, again

import glidar

TRIANGLE = ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])


def box(**placing):
    scene = glidar.Scene()
    scene.add_model("builtin:box", **placing)
    return scene


def stretched_twice():
    scene = glidar.Scene("builtin:sphere")
    scene.objects[0].scale = (1, 2, 3)
    scene.objects[0].scale = (2, 2, 3)
    return scene


def stretched_and_back():
    scene = glidar.Scene("builtin:sphere")
    scene.objects[0].scale = (1, 2, 3)
    scene.objects[0].scale = 2
    return scene


def stretched_when_added():
    scene = box(scale=(1, 2, 3))
    scene.objects[0].scale = (3, 2, 1)
    return scene


def stretched_in_turn():
    scene = glidar.Scene()
    first, second, third = (scene.add_model("builtin:box", name=name) for name in "abc")
    third.pose = glidar.pose([0, 0, 5])
    first.pose = glidar.pose([0, 5, 0])
    second.scale = (2, 2, 3)
    first.scale = (2, 2, 3)
    third.scale = (4, 2, 3)
    scene.add_mesh(*TRIANGLE, name="d")
    second.scale = 1.0
    scene.add_mesh(*TRIANGLE, name="e", scale=(1, 5, 1))
    first.scale = (2, 2, 4)
    return scene


def stretched_after_a_refusal():
    scene = box()
    with pytest.raises(glidar.Error):
        scene.add_model("builtin:sphere", scale=(1, 2, 3), id=1)
    scene.objects[0].scale = (1, 1, 2)
    return scene


STRETCHED = [stretched_twice, stretched_and_back, stretched_when_added, stretched_in_turn, stretched_after_a_refusal]


@pytest.mark.parametrize("make", STRETCHED)
def test_a_scene_with_rescaled_objects_survives_pickling(make):
    scene = make()
    back = again(scene)
    assert back == scene == again(back) == copy.deepcopy(scene)
    assert [o.scale for o in back] == [o.scale for o in scene]
    for one, other in zip(back, scene, strict=True):
        assert one.mesh == other.mesh
    camera, pose = glidar.camera(64, 64, fov_deg=60), glidar.look_at([9, 7, 8], [0, 0, 0])
    frame = glidar.simulate(scene, camera, pose, columns="all")
    assert frame.hits > 50
    assert glidar.simulate(back, camera, pose, columns="all") == frame
    assert again(frame).cloud("all", frame="world") == frame.cloud("all", frame="world")
    assert str(again(frame).explain(2000)) == str(frame.explain(2000))


def test_earlier_scales_do_not_affect_equality():
    scene = box()
    scene.objects[0].scale = (1, 2, 3)
    assert scene != box()
    scene.objects[0].scale = 1.0
    assert scene == box()
    assert box(scale=(1, 2, 3)) != box(scale=(1, 3, 2))


def test_earlier_classes_do_not_affect_equality():
    scene = box()
    scene.objects[0].class_name = "x"
    assert scene != box()
    scene.objects[0].class_name = "unlabelled"
    assert scene == box()
    assert again(scene) == scene
    assert again(scene).class_names == ["unlabelled", "x"]


def test_class_numbers_affect_equality():
    one, other = box(class_name="a"), box(class_name="b")
    other.objects[0].class_name = "a"
    assert other != one
    assert again(other) == other


def test_earlier_materials_do_not_affect_equality():
    red, green = ({"*": {"diffuse": colour}} for colour in ([0.9, 0, 0], [0, 0.9, 0]))
    scene = box(materials=red)
    assert scene != box(materials=green)
    scene.objects[0].set_materials(green)
    assert scene == box(materials=green)
    assert again(scene) == scene


def test_a_model_that_could_not_be_added_does_not_affect_equality():
    scene = box(name="box")
    for wrong in ({"name": "box"}, {"scale": (1, 2, 0)}, {"scale": (1, 2, 3), "id": 1}, {"class_name": "x", "id": -1}):
        with pytest.raises(glidar.Error):
            scene.add_model("builtin:sphere", **wrong)
        assert scene == box(name="box")
        assert again(scene) == scene


def test_equality_depends_on_the_contents_of_meshes_only():
    one, other = glidar.Scene(), glidar.Scene()
    for scene in (one, other):
        scene.add_mesh(*TRIANGLE, name="a")
    one.add_instance(one["a"], name="b")  # shares the mesh
    other.add_mesh(*TRIANGLE, name="b", id=2)
    assert one == other
    other.add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 1e-6]], [[0, 1, 2]], name="c")
    one.add_instance(one["a"], name="c")
    assert one != other


@pytest.fixture
def textures(tmp_path):
    image = pytest.importorskip("PIL.Image")
    image.new("L", (4, 4), 200).save(tmp_path / "noise.png")
    return tmp_path


def test_rejected_materials_leave_the_scene_unchanged(textures):
    scene = glidar.Scene(ROOT / "models/satellite/satellite.obj")
    object_, before = scene.objects[0], copy.copy(scene)
    assert len(object_.materials) > 1
    first, second = object_.materials[:2]
    changes = {first: {"noise_texture": str(textures / "noise.png")}, second: {"noise_texture": str(textures / "no.png")}}
    with pytest.raises(glidar.Error, match=r"no\.png"):
        object_.set_materials(changes)
    assert scene == before
    assert again(scene) == scene
    object_.set_materials({second: {"noise_texture": str(textures / "noise.png")}})
    assert again(scene) == scene != before


def test_a_rejected_scale_leaves_the_scene_unchanged():
    scene = box(scale=(1, 2, 3))
    for wrong in ((1, 2, 0), (1, 2, np.nan), (1e15, 1e-300, 1)):
        try:
            scene.objects[0].scale = wrong
        except glidar.Error:
            assert scene == box(scale=(1, 2, 3))
        assert again(scene) == scene
        scene.objects[0].scale = (1, 2, 3)


def resident_mib():
    with open("/proc/self/status", encoding="ascii") as status:
        return int(next(line for line in status if line.startswith("VmRSS")).split()[1]) / 1024


def test_memory_does_not_grow_when_an_object_is_scaled_often():
    scene = glidar.Scene("builtin:asteroid")
    rock = scene.objects[0]
    for k in range(10):
        rock.scale = (1, 1, 2 + k)
    before, length = resident_mib(), len(pickle.dumps(scene))
    for k in range(200):
        rock.scale = (1, 1.5, 2 + 0.01 * k)
    assert resident_mib() - before < 50  # 200 scaled copies of the asteroid would need 360 MiB
    assert abs(len(pickle.dumps(scene)) - length) < 100
    assert again(scene) == scene


def test_scenes_without_relative_paths_work_in_a_deleted_folder(tmp_path, monkeypatch):
    model = tmp_path / "one.obj"
    model.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    scene = glidar.Scene("builtin:box")
    scene.add_model(model, materials={"*": {"diffuse": [1, 0, 0]}})
    described = glidar.Scene.from_dict({"models": [{"model": "builtin:box"}, {"model": str(model)}]})
    stored = pickle.dumps((scene, described))
    assert pickle.loads(stored) == (scene, described)
    monkeypatch.chdir(tmp_path)
    assert pickle.loads(stored) == (scene, described)
