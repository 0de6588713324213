# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Scenes from files, models and arrays."""

import copy

import numpy as np
import pytest
from conftest import ROOT, again, same

import glidar

BOX = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)
POSE = glidar.look_at([4, -6, 3], [0, 0, 0])


def test_mesh_from_arrays_is_measured_like_the_same_model_file(camera):
    scene = glidar.Scene()
    scene.add_mesh(BOX, FACES)
    ours = glidar.simulate(scene, camera, POSE)
    theirs = glidar.simulate(glidar.Scene("builtin:box"), camera, POSE)
    assert ours.hits == theirs.hits > 0
    assert np.allclose(ours.range_m, theirs.range_m, atol=1e-6, equal_nan=True)
    assert np.allclose(ours.ground_truth.normal, theirs.ground_truth.normal, atol=1e-6, equal_nan=True)


def test_mesh_far_from_its_origin_keeps_its_precision(camera):
    far = np.array([1e6, -2e6, 3e5])
    scene = glidar.Scene()
    scene.add_mesh(BOX + far + 0.123456789, FACES)
    moved = POSE.copy()
    moved[:3, 3] += far + 0.123456789
    near = glidar.Scene()
    near.add_mesh(BOX, FACES)
    a, b = glidar.simulate(scene, camera, moved), glidar.simulate(near, camera, POSE)
    assert np.allclose(a.range_m, b.range_m, atol=1e-6, equal_nan=True)


def test_meshes_convert_from_and_to_trimesh(camera):
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.7)
    scene = glidar.Scene()
    added = scene.add_mesh(ball, name="ball")
    assert added.triangles == len(ball.faces)
    frame = glidar.simulate(scene, camera, glidar.look_at([5, 0, 0], [0, 0, 0]))
    assert np.nanmin(frame.range_m) == pytest.approx(4.3, abs=5e-3)
    back = added.mesh.to_trimesh()
    assert np.allclose(back.vertices, ball.vertices, atol=1e-7)
    assert np.array_equal(back.faces, ball.faces)
    assert back.volume == pytest.approx(ball.volume, rel=1e-6)


def test_meshes_and_clouds_convert_from_and_to_open3d(camera):
    open3d = pytest.importorskip("open3d")
    box = open3d.geometry.TriangleMesh.create_box()
    scene = glidar.Scene()
    scene.add_mesh(glidar.from_open3d(box))
    frame = glidar.simulate(scene, camera)
    points = frame.cloud(frame="world").to_open3d()
    assert len(points.points) == frame.hits
    assert len(scene.objects[0].mesh.to_open3d().triangles) == 12


def test_normals_uvs_and_colours_are_kept():
    rng = np.random.default_rng(1)
    normals = BOX / np.linalg.norm(BOX, axis=1, keepdims=True)
    uvs, colours = rng.random((8, 2)), rng.random((8, 3))
    scene = glidar.Scene()
    mesh = scene.add_mesh(BOX, FACES, normals=normals, uvs=uvs, colours=colours).mesh
    for given, kept in ((BOX, mesh.vertices), (normals, mesh.normals), (uvs, mesh.uvs), (colours, mesh.colours)):
        assert np.allclose(given, kept, atol=1e-7)
    assert np.array_equal(mesh.triangles, FACES)
    frame = glidar.simulate(scene, glidar.camera(), POSE, columns="all")
    assert not np.allclose(frame.ground_truth.normal, frame.ground_truth.shading_normal, equal_nan=True)


def test_objects_have_poses_names_and_editable_attributes(camera):
    scene = glidar.Scene()
    first = scene.add_model("builtin:sphere", name="sun", pose=glidar.pose([0, 0, 5]), scale=2.0, id=9, class_name="star")
    second = scene.add_instance(first, name="moon", pose=np.eye(4))
    assert [o.name for o in scene] == ["sun", "moon"]
    assert (first.id, first.scale, first.class_name, second.scale) == (9, 2.0, "star", 2.0)
    assert scene["moon"].index == 1
    low, high = scene.bounds
    assert low == pytest.approx([-2, -2, -2], abs=1e-6)
    assert high == pytest.approx([2, 2, 7], abs=1e-6)
    before = glidar.simulate(scene, camera, POSE)
    kept = before.range_m.copy()
    second.pose = glidar.pose([0, 0, -50])
    after = glidar.simulate(scene, camera, POSE)
    assert not same(before, after)
    assert np.array_equal(before.range_m, kept, equal_nan=True)
    assert np.array_equal(before.world_from_objects[1], np.eye(4))


def test_scales_per_axis_can_be_set_and_reset(camera):
    scene = glidar.Scene()
    ball = scene.add_model("builtin:sphere", scale=(2.0, 0.5, 1.25))
    assert ball.scale == (2.0, 0.5, 1.25)
    low, high = scene.bounds
    assert high - low == pytest.approx([4, 1, 2.5], abs=1e-5)
    assert ball.mesh.vertices.max() == pytest.approx(1.0, abs=1e-3)  # before scale
    frame = glidar.simulate(scene, camera, POSE, columns="all")
    hit = frame.status == glidar.Status.hit
    point = frame.ground_truth.object_point_m[hit] * np.array(ball.scale)
    # on the ellipsoid except for the facets of the mesh
    assert np.allclose(np.sum((point / np.array(ball.scale)) ** 2, axis=1), 1.0, atol=0.01)
    ball.scale = 3
    assert ball.scale == 3.0
    assert scene.bounds[1] == pytest.approx([3, 3, 3], abs=1e-5)
    for bad in (0, -1e300, (1, 0, 1), (1, 2), np.nan, (1, np.nan, 1), "big"):
        with pytest.raises(glidar.Error, match="scale"):
            ball.scale = bad
    assert ball.scale == 3.0


def test_built_in_models_have_sizes():
    box = glidar.Scene("builtin:box:size=4,2,1")
    assert box.objects[0].name == "box"
    assert box.bounds[1] == pytest.approx([2, 1, 0.5])
    with pytest.raises(glidar.Error, match="'sise' is not a size of this model.*did you mean 'size'"):
        glidar.Scene("builtin:box:sise=4")


def test_declared_units_and_up_axes_apply_unless_overridden(tmp_path):
    (tmp_path / "a.amf").write_text(
        '<?xml version="1.0"?><amf unit="inch"><object id="1"><mesh><vertices>'
        + "".join(f"<vertex><coordinates><x>{x}</x><y>{y}</y><z>{z}</z></coordinates></vertex>" for x, y, z in np.eye(3))
        + "</vertices><volume><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh></object></amf>"
    )
    path = tmp_path / "a.amf"
    assert glidar.Scene(path).bounds[1] == pytest.approx(np.full(3, 0.0254), rel=1e-6)
    assert glidar.Scene(path, unit="m").bounds[1] == pytest.approx(np.ones(3))
    centred = glidar.Scene(path, unit="m", centre=True).bounds
    assert centred[0] == pytest.approx(np.full(3, -0.5))
    with pytest.raises(glidar.Error, match="centre"):
        glidar.Scene(path, centre=1)


def test_frames_keep_the_scene_as_it_was_measured(camera):
    scene = glidar.Scene("builtin:sphere")
    scene.objects[0].id = 3
    frame = glidar.simulate(scene, camera, POSE)
    scene.objects[0].id = 4
    seen = frame.cloud(["instance"], drop_invalid=True)["instance"]
    assert set(seen) == {3}


def test_materials_have_the_keys_of_scene_files():
    sensor = glidar.load_sensor("VLP-16")
    pose = np.eye(4)
    scene = glidar.Scene("builtin:box")
    plain = glidar.simulate(scene, sensor, pose).intensity
    scene.objects[0].set_materials({"*": {"surface": glidar.surface_names()[0], "mirror": 0.0}})
    assert not np.array_equal(glidar.simulate(scene, sensor, pose).intensity, plain)
    with pytest.raises(glidar.Error, match="did you mean 'diffuse'") as caught:
        scene.objects[0].set_materials({"*": {"difuse": [1, 1, 1]}})
    assert "materials" in caught.value.where
    with pytest.raises(glidar.Error, match="has no material 'paint'"):
        scene.objects[0].set_materials({"paint": {}})


def test_scene_file_provides_sensor_pose_and_motion(tmp_path):
    (tmp_path / "scene.yaml").write_text(
        "models:\n  - {model: 'builtin:torus', name: ring, motion: {spin: {rate_deg_s: [0, 0, 90]}}}\n"
        "sensor: {optics: {type: pinhole, width: 40, height: 30, fov_deg: 40}}\n"
        "sensor_pose: {look_at: {eye: [5, 0, 2], target: [0, 0, 0]}}\n"
    )
    scene = glidar.Scene(tmp_path / "scene.yaml")
    assert scene.sensor.cols == 40
    frame = glidar.simulate(scene)
    assert np.array_equal(frame.world_from_sensor, glidar.look_at([5, 0, 2], [0, 0, 0]))
    later = glidar.simulate(scene, frame=30)
    assert later.stamp_ns == 1_000_000_000
    assert later.world_from_objects[0][:2, :2] == pytest.approx(np.array([[0, -1], [1, 0]]), abs=1e-9)


def test_a_dict_is_the_same_as_the_file_with_its_keys(tmp_path):
    yaml = pytest.importorskip("yaml")
    path = ROOT / "examples/rig.yaml"
    scene = glidar.Scene.from_dict(yaml.safe_load(path.read_text()))
    ours, theirs = glidar.simulate_rig(scene, seed=3), glidar.simulate_rig(glidar.Scene(path), seed=3)
    assert list(ours) == ["lidar", "camera"]
    assert all(same(ours[name], theirs[name]) for name in ours)
    with pytest.raises(glidar.Error, match="scene: models\\[0\\].modle: unknown key"):
        glidar.Scene.from_dict({"models": [{"modle": "builtin:box"}]})


def test_a_rig_is_measured_like_on_the_command_line(tmp_path, program):
    path = ROOT / "examples/rig.yaml"
    program("render", path, "--seed", 5, "--columns", "all", "-o", tmp_path / "a.npz")
    scene = glidar.Scene(path)
    assert scene.sensor is None
    assert [mount.number for mount in scene.rig.values()] == [0, 1]
    for name, frame in glidar.simulate_rig(scene, seed=5, columns="all").items():
        frame.save(tmp_path / "ours.npz", columns="all")
        assert (tmp_path / "ours.npz").read_bytes() == (tmp_path / f"a_{name}.npz").read_bytes()
        assert frame.sensor_id == scene.rig[name].number
    with pytest.raises(glidar.Error, match="a rig of 2; allowed: one of scene.rig: lidar, camera"):
        glidar.simulate(scene)
    moved = glidar.simulate_rig(scene, glidar.pose([0, 0, 1]))
    assert moved["lidar"].world_from_sensor[:3, 3] == pytest.approx([0, 0, 1.2])
    with pytest.raises(glidar.Error, match="the scene has no sensors"):
        glidar.simulate_rig(glidar.Scene("builtin:box"))


def test_models_accept_texture_folders(tmp_path, caplog):
    for name in ("model", "art/images"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "art/images/a.ppm").write_text("P6 1 1 255\nabc")
    (tmp_path / "model/a.mtl").write_text("newmtl m\nmap_Kd ../images/a.ppm\n")
    model = tmp_path / "model/a.obj"
    model.write_text("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n")
    glidar.Scene(model)
    assert "--texture-folder" in caplog.text
    caplog.clear()
    scene = glidar.Scene(model, texture_folder=tmp_path / "art")
    scene.add_model(model, texture_folder=[str(tmp_path / "art/images"), tmp_path])
    glidar.Scene.from_dict({"models": [{"model": str(model), "texture_folder": [str(tmp_path / "art")]}]})
    assert "missing" not in caplog.text
    with pytest.raises(glidar.Error, match="is not a folder"):
        glidar.Scene(model, texture_folder=tmp_path / "gone")
    with pytest.raises(glidar.Error, match="texture_folder"):
        glidar.Scene(model, texture_folder=3)


def test_models_accept_units_and_up_axes():
    path = ROOT / "models/satellite/satellite.obj"
    metres, inches = glidar.Scene(path), glidar.Scene(path, unit="in", up="y")
    size, small = (np.subtract(*reversed(s.bounds)) for s in (metres, inches))
    assert sorted(small) == pytest.approx(sorted(0.0254 * size), rel=1e-6)
    assert len(metres.objects[0].materials) > 1


@pytest.mark.parametrize(
    ("vertices", "triangles", "words"),
    [
        (BOX[:, :2], FACES, "vertices: an array 8 x 2; allowed: an array n x 3"),
        (np.where(BOX == 1, np.nan, BOX), FACES, "vertices: nan at [0, 0]".replace("[0, 0]", "[1, 2]")),
        (BOX[:0], FACES, "vertices: an array 0 x 3"),
        (BOX, FACES + 1, "triangles: indices from 1 to 8; allowed: 0 to 7"),
        (BOX, FACES.astype(float), "triangles: an array 12 x 3 of float64"),
        (BOX, FACES[:0], "triangles: an array 0 x 3"),
        (BOX.astype(str), FACES, "vertices: an array of <U"),
        ("box", None, "mesh: a str"),
    ],
)
def test_invalid_arrays_raise_an_error(vertices, triangles, words):
    scene = glidar.Scene()
    with pytest.raises(glidar.Error) as caught:
        scene.add_mesh(vertices, triangles)
    assert words in str(caught.value)
    assert len(scene) == 0


def test_errors_in_files_are_identical_to_those_of_the_command_line(tmp_path, program):
    (tmp_path / "scene.yaml").write_text("models:\n  - modl: builtin:box\n")
    printed = program("render", "scene.yaml", "-o", "x.pcd", folder=tmp_path, code=2)
    with pytest.raises(glidar.Error) as caught:
        glidar.Scene(tmp_path / "scene.yaml")
    assert str(caught.value).replace(f"{tmp_path}/", "") in printed
    assert caught.value.where.endswith("scene.yaml:2:5: models[0].modl")
    for name in ("builtin:boxx", "nowhere.obj"):
        printed = program("render", name, "-o", "x.pcd", folder=tmp_path, code=2)
        with pytest.raises(glidar.Error) as caught:
            glidar.Scene(name)
        assert str(caught.value) in printed


def test_unknown_objects_and_invalid_settings_raise_an_error():
    scene = glidar.Scene("builtin:box")
    with pytest.raises(glidar.Error, match="'ball'"):
        scene["ball"]
    for setting, value in (("scale", 0.0), ("scale", np.nan), ("pose", np.ones((4, 4))), ("id", -1)):
        with pytest.raises(glidar.Error):
            setattr(scene.objects[0], setting, value)
    assert scene.objects[0].scale == 1.0
    with pytest.raises(glidar.Error, match="argument: 'colour'"):
        scene.add_model("builtin:box", colour="red")
    with pytest.raises(glidar.Error, match="unit: 'yd'"):
        glidar.Scene("builtin:box", unit="yd")
    with pytest.raises(glidar.Error, match="sensor: the scene file has no sensor"):
        glidar.simulate(scene)


def test_tensor_meshes_of_open3d_are_accepted(camera):
    open3d = pytest.importorskip("open3d")
    added = glidar.Scene().add_mesh(open3d.t.geometry.TriangleMesh.create_box())
    assert added.triangles == 12


def test_normals_and_colours_out_of_range_are_rejected():
    scene = glidar.Scene()
    for arguments, words in (
        ({"normals": 2 * BOX}, "unit vectors"),
        ({"colours": BOX}, "-1 to 1"),
        ({"colours": 255 * (BOX + 1) / 2}, "divide 8-bit colours by 255"),
    ):
        with pytest.raises(glidar.Error, match=words):
            scene.add_mesh(BOX, FACES, **arguments)
    assert len(scene) == 0
    scene.add_mesh(BOX, FACES, normals=np.zeros((8, 3)), colours=(BOX + 1) / 2)


def test_arrays_cannot_be_combined_with_a_mesh():
    mesh = glidar.Mesh(BOX, FACES)
    for more in ("normals", "uvs", "colours"):
        with pytest.raises(glidar.Error, match="given with a mesh"):
            glidar.Scene().add_mesh(mesh, **{more: BOX})


def test_instances_require_an_object_of_the_same_scene():
    ball = glidar.Scene("builtin:sphere")
    for scene in (glidar.Scene("builtin:asteroid"), glidar.Scene()):
        with pytest.raises(glidar.Error, match="belongs to another scene"):
            scene.add_instance(ball.objects[0])
        assert "sphere" not in repr(scene)


def test_meshes_are_equal_when_their_arrays_are_identical():
    mesh = glidar.Mesh(np.array(BOX), FACES)
    assert mesh == glidar.Mesh(np.array(BOX), FACES)
    assert mesh != glidar.Mesh(np.array(BOX) + 1, FACES)
    assert mesh != glidar.Mesh(np.array(BOX, np.float32), FACES)
    assert mesh != "a mesh"
    with pytest.raises(TypeError):
        hash(mesh)


def test_attributes_of_new_objects_are_optional():
    added = glidar.Scene().add_model("builtin:box", pose=None, materials=None, name=None)
    assert np.array_equal(added.pose, np.eye(4))


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda s: s.add_mesh([[0, 0, 0], [1, 0]], FACES), "vertices: not an array"),
        (lambda s: s.add_mesh(BOX, [[0, 1, 2], [0]]), "triangles: not an array"),
        (lambda s: s.add_mesh(BOX, FACES, name=5), "name: 5"),
        (lambda s: setattr(s.objects[0], "name", 5), "name: 5"),
        (lambda s: setattr(s.objects[0], "class_name", 5), "class_name: 5"),
        (lambda s: setattr(s.objects[0], "id", [1]), r"id: \[1\]"),
        (lambda s: setattr(s.objects[0], "scale", "big"), "allowed: a real number"),
        (lambda s: glidar.Scene(5), "scene: a int"),
        (lambda s: s.add_model(5), "model: a int"),
        (lambda s: glidar.load_sensor(5), "sensor: a int"),
        (lambda s: glidar.simulate(s, 5), "sensor: a int"),
        (lambda s: glidar.simulate("builtin:box"), "scene: a str"),
        (lambda s: glidar.simulate_rig("builtin:box"), "scene: a str"),
        (lambda s: glidar.simulate(s, glidar.camera(8, 8), columns=5), "columns: 5"),
        (lambda s: glidar.simulate(s, glidar.camera(8, 8), columns=[5]), "columns: 5"),
    ],
)
def test_values_of_another_type_raise_an_error(call, words):
    with pytest.raises(glidar.Error, match=words):
        call(glidar.Scene("builtin:box"))


def test_recursive_descriptions_raise_an_error():
    endless = {}
    endless["models"] = endless
    with pytest.raises(glidar.Error, match="levels deep"):
        glidar.Scene.from_dict(endless)


def poses_along_x(count):
    poses = np.tile(np.eye(4), (count, 1, 1))
    poses[:, 0, 3] = 3.0 * np.arange(count)
    return poses


def test_instances_from_an_array_of_poses_are_those_added_one_by_one(camera):
    scenes = []
    for at_once in (True, False):
        scene = glidar.Scene()
        box = scene.add_mesh(BOX, FACES, name="box", class_name="crate")
        scene.add_instance(box, name="box_3", id=3)
        poses = poses_along_x(4)
        added = scene.add_instances(box, poses) if at_once else [scene.add_instance(box, pose=pose) for pose in poses]
        assert [one.name for one in added] == ["box_2", "box_4", "box_5", "box_6"]
        assert [one.id for one in added] == [4, 5, 6, 7]
        assert {one.class_name for one in added} == {"crate"}
        assert len({one.id for one in scene.objects}) == 6
        scenes.append(scene)
    assert scenes[0] == again(scenes[0]) == copy.copy(scenes[0])
    assert same(*(glidar.simulate(scene, camera, POSE) for scene in scenes))


def test_invalid_instances_leave_the_scene_unchanged():
    scene = glidar.Scene()
    box = scene.add_mesh(BOX, FACES)
    before = copy.copy(scene)
    wrong = poses_along_x(3)
    wrong[2, 0, 0] = 2.0
    for poses, words in ((wrong, "poses"), (np.zeros((2, 3, 4)), "poses"), (np.full((1, 4, 4), np.nan), "poses")):
        with pytest.raises(glidar.Error, match=words):
            scene.add_instances(box, poses)
    with pytest.raises(glidar.Error, match="belongs to another scene"):
        before.add_instances(box, poses_along_x(1))
    assert scene == before


def test_adding_and_moving_instances_takes_time_that_does_not_depend_on_the_scene():
    """Counts reads of other objects, of which adding by comparing needs one for each object before."""
    scene = glidar.Scene()
    box = scene.add_mesh(BOX, FACES)
    scene.add_instances(box, poses_along_x(5000))
    scene.add_instance(box)  # passes all names in use, once
    looked_up = []
    register = scene._recipe.register(len(scene))
    is_taken = register.is_taken
    register.is_taken = lambda *arguments: looked_up.append(arguments) or is_taken(*arguments)
    reads = []
    core = scene._recipe.core
    scene._recipe.core = type("Counting", (), {
        "__getattr__": lambda self, name: getattr(core, name),
        "__len__": lambda self: len(core),
        "object": lambda self, index: reads.append(index) or core.object(index)})()
    for number in range(10):
        scene.add_instance(box, pose=np.eye(4), name=f"new {number}")
        scene.objects[-1].name = f"renamed {number}"
    assert len(reads) < 100
    assert len(looked_up) < 200


def test_names_and_ids_that_were_given_up_are_free_again():
    scene = glidar.Scene()
    box = scene.add_mesh(BOX, FACES, name="box")
    second = scene.add_instance(box)
    assert (second.name, second.id) == ("box_2", 2)
    second.name, second.id = "other", 9
    assert [(one.name, one.id) for one in (scene.add_instance(box), scene.add_instance(box))] == [("box_2", 3), ("box_3", 4)]
    with pytest.raises(glidar.Error, match="another object has"):
        second.name = "box_3"
    with pytest.raises(glidar.Error, match="another object has"):
        second.id = 4
    second.name, second.id = "other", 9
