# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Parts of models: classes, ids, poses and visibility of their own, and labels in every format that has them."""

import copy
import json
import pickle

import numpy as np
import pytest

import glidar
from glidar.nuscenes import NuscenesWriter

# Three squares of 1 m side by side at x = 5, facing the sensor: two of steel, one of glass.
MODEL = """mtllib a.mtl
v 5 -1.5 0\nv 5 -0.5 0\nv 5 0.5 0\nv 5 1.5 0\nv 5 -1.5 1\nv 5 -0.5 1\nv 5 0.5 1\nv 5 1.5 1
usemtl steel
o left
f 1 5 6 2
o middle
f 2 6 7 3
g window
usemtl glass
f 3 7 8 4
"""
NAMES = ["left", "middle", "middle/window"]


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    path = tmp_path_factory.mktemp("parts") / "wall.obj"
    path.write_text(MODEL)
    (path.parent / "a.mtl").write_text("newmtl steel\nnewmtl glass\n")
    return path


def measured(scene, **options):
    sensor = glidar.load_sensor("VLP-16").ground_truth()
    return glidar.simulate(scene, sensor, pose=glidar.pose([0.0, 0.0, 0.5]), columns="all", **options)


def expected_labels(frame, split="parts"):
    """Label of each point that was hit, by its place: ids from 1 from left to right."""
    y = frame.cloud(["true_xyz"])["true_xyz"][..., 1]
    hit = np.isfinite(y)
    return labels_at(y, split)[hit], hit


def test_parts_are_listed(model):
    parts = glidar.list_parts(model)
    assert [part.name for part in parts] == NAMES
    assert [part.parent for part in parts] == ["", "", "middle"]
    assert [part.triangles for part in parts] == [2, 4, 2]
    assert parts[1].materials == ["steel", "glass"]
    np.testing.assert_array_equal(parts[2].minimum, [5.0, 0.5, 0.0])
    np.testing.assert_array_equal(parts[2].maximum, [5.0, 1.5, 1.0])
    np.testing.assert_array_equal(parts[2].pose, np.eye(4))


COLLADA = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.01"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g" name="triangle"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s" name="Scene">
<node id="robot" name="robot"><translate>0 0 100</translate><node id="arm" name="arm"><translate>200 0 0</translate>
<instance_geometry url="#g"/></node><node id="lamp" name="lamp"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


def test_nodes_of_collada_are_parts_with_their_frames(tmp_path):
    (tmp_path / "a.dae").write_text(COLLADA)
    parts = glidar.list_parts(tmp_path / "a.dae")
    assert [part.name for part in parts] == ["robot", "robot/arm"]
    np.testing.assert_allclose([part.pose[:3, 3] for part in parts], [[0, 0, 1], [2, 0, 0]], atol=1e-6)
    scene = glidar.Scene()
    (arm,) = scene.add_parts(tmp_path / "a.dae", parts={"robot/arm": {"pose": {"position": [0, 5, 0]}}})
    low, high = scene.bounds
    np.testing.assert_allclose([low, high], [[0, 5, 1], [0.01, 5.01, 1]], atol=1e-6)
    assert arm.name == "a/robot/arm"


def test_the_program_lists_the_same_parts(model, program):
    listed = json.loads(program("info", model, "--parts", "--json"))
    assert [(part["name"], part["triangles"]) for part in listed] == [("left", 2), ("middle", 4), ("middle/window", 2)]
    text = program("info", model, "--parts")
    assert "middle/window" in text and "glass" in text


def test_split_labels_points_by_part_and_by_material(model):
    scene = glidar.Scene()
    parts = scene.add_parts(model, split="parts")
    assert [(part.id, part.class_name) for part in parts] == [(1, "left"), (2, "middle"), (3, "middle/window")]
    frame = measured(scene)
    expected, hit = expected_labels(frame)
    assert len(np.unique(expected)) == 3
    np.testing.assert_array_equal(frame.cloud(["instance"])["instance"][hit], expected)
    scene = glidar.Scene()
    materials = scene.add_parts(model, split="materials")
    assert [(part.id, part.class_name) for part in materials] == [(1, "steel"), (2, "glass")]
    np.testing.assert_array_equal(measured(scene).cloud(["class"])["class"][hit], np.where(expected == 3, 2, 1))


@pytest.fixture(scope="module", params=["parts", "materials"])
def split(request):
    return request.param


@pytest.fixture(scope="module")
def split_frame(model, split):
    scene = glidar.Scene()
    scene.add_parts(model, split=split)
    return measured(scene)


def labels_at(y, split):
    """The label of each point at x = 5, by its place."""
    part = np.where(y < -0.5, 1, np.where(y < 0.5, 2, 3))
    return part if split == "parts" else np.where(part == 3, 2, 1)


def labels_of_text(path, separator=" ", header="", rows="data"):
    """The column `instance` of a text file whose lines after a header are points."""
    lines = path.read_text().splitlines()
    names = next(line for line in lines if line.startswith(header)).removeprefix(header).split(separator)
    start = next(k for k, line in enumerate(lines) if line.startswith(rows)) + 1
    column = [name.strip() for name in names].index("instance")
    return np.array([float(line.split(separator)[column]) for line in lines[start:]], int)


def labels_of_ply(path):
    lines = path.read_text().splitlines()
    names = [line.split()[-1] for line in lines if line.startswith("property")]
    rows = lines[lines.index("end_header") + 1 :]
    return np.array([int(row.split()[names.index("instance")]) for row in rows])


def labels_of_kitti(path):
    return np.fromfile(path, "<u4") >> 16


def labels_of_las(path):
    return np.asarray(pytest.importorskip("laspy").read(path)["instance"])


def labels_of_image(path):
    from PIL import Image

    pixels = np.asarray(Image.open(path)).ravel()
    return pixels[pixels != 0]


def labels_of_exr(path):
    (part,) = pytest.importorskip("OpenEXR").File(str(path), separate_channels=True).parts
    labels = part.channels["instance"].pixels.ravel()
    return labels[labels != 2**32 - 1]


def labels_of_bag(path):
    rosbags = pytest.importorskip("rosbags.highlevel")
    with rosbags.AnyReader([path]) as bag:
        for connection, _, raw in bag.messages():
            if connection.msgtype.endswith("PointCloud2"):
                cloud = bag.deserialize(raw, connection.msgtype)
                field = next(one for one in cloud.fields if one.name == "instance")
                rows = cloud.data.reshape(-1, cloud.point_step)[:, field.offset : field.offset + 4]
                labels = np.ascontiguousarray(rows).view("<u4").ravel()
                return labels[labels != 2**32 - 1]
    raise AssertionError("no cloud")


COLUMNS = {"columns": ["xyz", "instance", "class"], "drop_invalid": True}
FORMATS = {
    "a.npz": (COLUMNS, lambda path: np.load(path)["instance"].ravel()),
    "a.csv": (COLUMNS, lambda path: labels_of_text(path, ",", "", "")),
    "a.pcd": ({**COLUMNS, "pcd": "ascii"}, lambda path: labels_of_text(path, " ", "FIELDS ", "DATA")),
    "a.ply": ({**COLUMNS, "ply_ascii": True}, labels_of_ply),
    "a.bin": ({}, lambda path: labels_of_kitti(path.with_suffix(".label"))),
    "a.kitti": ({}, lambda path: labels_of_kitti(path / "labels" / "000000.label")),
    "a.las": ({}, labels_of_las),
    "a.instance.png": ({}, labels_of_image),
    "a.class.png": ({}, labels_of_image),
    "a.exr": ({"columns": ["xyz", "instance"]}, labels_of_exr),
    "a.mcap": ({"columns": ["xyz", "instance"]}, labels_of_bag),
    "a.rosbag2": ({"columns": ["xyz", "instance"]}, labels_of_bag),
}


@pytest.mark.parametrize("name", FORMATS)
def test_labels_by_part_and_by_material_are_in_every_format(split_frame, split, tmp_path, program, name):
    if name.endswith(".exr") and "OpenEXR" not in program("--version"):
        pytest.skip("this build has no OpenEXR; install libopenexr-dev and build again")
    expected, _ = expected_labels(split_frame, split)
    options, read = FORMATS[name]
    split_frame.save(tmp_path / name, **options)
    np.testing.assert_array_equal(np.bincount(read(tmp_path / name)), np.bincount(expected))


@pytest.fixture(scope="module")
def split_scene(model, split, tmp_path_factory):
    """A scene file with a LiDAR whose beams meet the wall at x = 5."""
    path = tmp_path_factory.mktemp("scene") / "scene.yaml"
    path.write_text(f"models: [{{model: '{model}', split: {split}}}]\n"
                    "sensors: [{name: lidar, sensor: VLP-16}]\nrig_pose: {position: [0, 0, 0.5]}\n")  # fmt: skip
    return path


def test_labels_by_part_and_by_material_are_in_osi_traces(split_scene, split, program, tmp_path):
    trace_reader = pytest.importorskip("osi3trace.osi_trace")
    program("render", split_scene, "--duration", 0.1, "-o", tmp_path / "a.osi")
    trace = trace_reader.OSITrace(str(tmp_path / "a.osi"), "SensorData")
    (message,) = list(trace)
    trace.close()
    detections = message.feature_data.lidar_sensor[0].detection
    y = 5.0 * np.tan([one.position.azimuth for one in detections])
    labels = [one.object_id.value for one in detections]
    assert len(np.unique(labels)) == (3 if split == "parts" else 2)
    np.testing.assert_array_equal(labels, labels_at(y, split))
    objects = message.sensor_view[0].global_ground_truth.stationary_object
    names = ["wall/left", "wall/middle", "wall/middle/window"] if split == "parts" else ["wall/steel", "wall/glass"]
    assert [one.source_reference[0].identifier[0] for one in sorted(objects, key=lambda one: one.id.value)] == names


def test_labels_by_part_and_by_material_are_in_nuscenes(split_scene, split, tmp_path):
    classes = NAMES if split == "parts" else ["steel", "glass"]
    known = ["vehicle.car", "vehicle.truck", "human.pedestrian.adult"]
    with NuscenesWriter(tmp_path / "data", categories=dict(zip(classes, known, strict=False))) as data:
        data.add_scene(glidar.Scene(split_scene), duration_s=0.1)
    names = {one["index"]: one["name"] for one in json.loads((tmp_path / "data/v1.0-mini/category.json").read_text())}
    (scan,) = (tmp_path / "data/samples/LIDAR_TOP").glob("*.bin")
    (labels,) = (tmp_path / "data/lidarseg/v1.0-mini").glob("*.bin")
    x, y = np.fromfile(scan, np.float32).reshape(-1, 5).T[:2]
    found = [names[index] for index in np.fromfile(labels, np.uint8)]
    assert found == [known[label - 1] for label in labels_at(5.0 * y / x, split)]
    assert len(set(found)) == len(classes)


def test_the_last_entry_decides_class_id_and_pose(model):
    scene = glidar.Scene()
    parts = {
        "middle": {"class": "door", "id": 40, "pose": glidar.pose([-2.0, 0.0, 0.0])},
        "material:glass": {"class": "glass"},
    }
    objects = scene.add_parts(model, parts=parts, name="wall", class_name="wall", pose=glidar.pose([1.0, 0.0, 0.0]))
    assert [one.name for one in objects] == ["wall", "wall/middle", "wall/material:glass"]
    assert [one.class_name for one in objects] == ["wall", "door", "glass"]
    assert [one.id for one in objects] == [1, 40, 41]
    assert [one.pose[0, 3] for one in objects] == [1.0, -1.0, -1.0]


def test_a_sensor_does_not_see_its_own_robot(model):
    description = {
        "models": [
            {"model": str(model), "hidden_from": ["front"], "parts": {"middle/window": {"visible_to": ["rear"]}}},
            {"model": "builtin:box", "pose": {"position": [8, 0, 0]}},
        ],
        "sensors": [{"name": "front", "sensor": "VLP-16"}, {"name": "rear", "sensor": "VLP-16"}],
        "rig_pose": {"position": [0, 0, 0.5]},
    }
    scene = glidar.Scene.from_dict(description)
    assert scene["wall"].hidden_from == ("front",)
    assert scene["wall/middle/window"].visible_to == ("rear",)
    frames = glidar.simulate_rig(scene, columns="all")
    seen = {name: set(np.unique(frame.ground_truth.instance[np.isfinite(frame.range_m)])) for name, frame in frames.items()}
    box = scene["box"].index
    assert seen["front"] == {box}
    assert seen["rear"] > {scene["wall"].index, scene["wall/middle/window"].index}


def test_objects_hide_from_sensors_by_name_or_number(model):
    scene = glidar.Scene()
    wall = scene.add_model(model, hidden_from=[1])
    assert wall.hidden_from == (1,)
    assert measured(scene, sensor_id=0).hits
    assert not measured(scene, sensor_id=1).hits
    wall.hidden_from = []
    wall.visible_to = [3]
    assert not measured(scene, sensor_id=1).hits
    assert measured(scene, sensor_id=3).hits
    with pytest.raises(glidar.Error, match="visible_to"):
        wall.visible_to = ["left"]
    with pytest.raises(glidar.Error, match="a list of names or sensor_ids"):
        wall.visible_to = "left"


def test_the_only_sensor_of_a_scene_is_called_sensor(model, program, tmp_path):
    models = (f"models:\n  - {{model: '{model}', hidden_from: [sensor]}}\n"
              "  - {model: 'builtin:box', id: 9, pose: {position: [8, 0, 0]}}\n")  # fmt: skip
    (tmp_path / "with.yaml").write_text(f"{models}sensor: VLP-16\nsensor_pose: {{position: [0, 0, 0.5]}}\n")
    (tmp_path / "without.yaml").write_text(models)
    for name, options in {"with": [], "without": ["--sensor", "VLP-16", "--sensor-pose", "0,0,0.5,1,0,0,0"]}.items():
        program("render", tmp_path / f"{name}.yaml", *options, "--columns", "xyz,instance", "--drop-invalid", "-o", tmp_path / "a.npz")
        assert set(np.unique(np.load(tmp_path / "a.npz")["instance"])) == {9}
    scene = glidar.Scene(tmp_path / "with.yaml")
    assert scene["wall"].hidden_from == ("sensor",)
    assert set(np.unique(glidar.simulate(scene, columns="all").ground_truth.instance)) == {1, 2**32 - 1}
    scene["wall"].hidden_from = []
    scene["wall"].visible_to = ["sensor"]
    assert scene["wall"].visible_to == ("sensor",)


def test_unknown_sensors_are_errors_that_list_the_known_ones(model):
    rig = glidar.Scene.from_dict({
        "models": [{"model": "builtin:box"}],
        "sensors": [{"name": "front", "sensor": "VLP-16"}, {"name": "rear", "sensor": "VLP-16"}]})  # fmt: skip
    for scene, known in ((rig, "'front', 'rear'"), (glidar.Scene("builtin:box"), "'sensor', its only one")):
        for arguments in ({"hidden_from": ["left"]}, {"visible_to": ["left"]}, {"parts": {"left": {"visible_to": ["left"]}}}):
            with pytest.raises(glidar.Error, match=f"no sensor 'left'; allowed: {known}"):
                scene.add_parts(model, **arguments)
        assert len(scene) == 1
    (wall,) = rig.add_parts(model, hidden_from=["rear"])
    assert wall.hidden_from == ("rear",)


def test_negative_scale_mirrors(model):
    scene = glidar.Scene()
    scene.add_parts(model, split="parts", scale=[1.0, -1.0, 1.0])
    frame = measured(scene)
    expected, hit = expected_labels(frame)
    np.testing.assert_array_equal(frame.cloud(["instance"])["instance"][hit], 4 - expected)
    normals = frame.cloud(["normal"])["normal"][hit]
    np.testing.assert_allclose(normals, np.broadcast_to([-1.0, 0.0, 0.0], normals.shape), atol=1e-6)
    single = glidar.Scene()
    box = single.add_model("builtin:box", scale=-2)
    assert box.scale == -2.0


def test_the_program_takes_negative_and_different_scales(model, program, tmp_path):
    """--scale mirrors as `scale` of scene files does."""
    pose = {"--eye": "-10,3,5", "--target": "5,0,0.5"}
    arguments = [str(one) for pair in pose.items() for one in pair]
    for scale in ("-2", "1,-1,1", "1,-2,0.5"):
        numbers = [float(one) for one in scale.split(",")]
        (tmp_path / "a.yaml").write_text(json.dumps({"models": [{"model": str(model), "scale": numbers * (3 // len(numbers))}]}))
        program("render", tmp_path / "a.yaml", *arguments, "-o", tmp_path / "a.pcd")
        program("render", model, "--scale", scale, *arguments, "-o", tmp_path / "b.pcd")
        assert (tmp_path / "a.pcd").read_bytes() == (tmp_path / "b.pcd").read_bytes()


def test_scenes_with_parts_are_copied_and_pickled(model):
    scene = glidar.Scene()
    scene.add_parts(model, split="parts", parts={"left": {"class": "first"}})
    scene.objects[0].hidden_from = [2]
    restored = pickle.loads(pickle.dumps(scene))
    assert restored == scene == copy.deepcopy(scene)
    assert restored.objects[0].hidden_from == (2,)
    assert [one.class_name for one in restored.objects] == ["first", "middle", "middle/window"]
    restored.objects[0].hidden_from = []
    assert restored != scene


def test_errors_leave_the_scene_unchanged(model):
    scene = glidar.Scene("builtin:box")
    with pytest.raises(glidar.Error, match="no part 'middle/windw'.*did you mean 'middle/window'"):
        scene.add_parts(model, parts={"middle/windw": {}})
    with pytest.raises(glidar.Error, match="split"):
        scene.add_parts(model, split="groups")
    with pytest.raises(glidar.Error, match="argument"):
        scene.add_parts(model, colour="red")
    assert len(scene) == 1
