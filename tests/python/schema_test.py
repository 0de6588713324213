# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The JSON Schemas by an independent validator."""

import copy
import itertools
import json
import pickle
import re
import subprocess
import zipfile
from pathlib import Path

import jsonschema
import pytest
import yaml

import glidar

ROOT = Path(__file__).resolve().parents[2]


class Loader(yaml.SafeLoader):
    """YAML 1.2's numbers, which have exponents without a point or sign."""


Loader.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$"),
                             list("-+.0123456789"))


def load(path):
    return yaml.load(path.read_text(encoding="utf-8"), Loader=Loader)  # noqa: S506 (a safe loader)


def validator(kind):
    text = subprocess.run(["glidar", "schema", kind], capture_output=True, check=True, text=True).stdout
    schema = json.loads(text)
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


@pytest.fixture(scope="module")
def sensor_schema():
    return validator("sensor")


PRESETS = sorted((ROOT / "sensors").glob("*.yaml"))


@pytest.mark.parametrize("preset", PRESETS, ids=lambda path: path.stem)
def test_presets_are_valid(sensor_schema, preset):
    sensor_schema.validate(load(preset))


def test_a_family_is_valid_without_the_keys_that_its_variants_complete(sensor_schema):
    document = {"optics": {"type": "spinning", "elevation_deg": [1, 2]}}
    assert not sensor_schema.is_valid(document)
    family = {**document, "variants": {"A": {"optics": {"columns_per_turn": 100}}}}
    sensor_schema.validate({**family, "modes": {"fast": {"rate_hz": 20}}, "default_mode": "fast"})
    for wrong in ({"variants": 3}, {"variants": {"A": 3}}, {"optics": {"columns_per_turm": 3}}, {"aliases": "a"}):
        assert not sensor_schema.is_valid({**family, **wrong}), wrong


@pytest.mark.parametrize("preset", glidar.sensor_names())
def test_to_dict_of_presets_is_valid_and_reads_back(sensor_schema, preset):
    sensor = glidar.load_sensor(preset)
    described = sensor.to_dict()
    sensor_schema.validate(json.loads(json.dumps(described)))
    assert glidar.Sensor.from_dict(described) == sensor


def test_surfaces_are_valid():
    validator("surfaces").validate(load(ROOT / "materials/surfaces.yaml"))


def test_materials_are_valid():
    schema = validator("materials")
    good = {"*": {"ambient": [0.1, 0.1, 0.1]}, "Panels": {"backscatter": {"type": "glossy", "lobe_gain": 3}, "mirror": 1}}
    schema.validate(good)
    good["Panels"]["backscatter"]["lobe_gian"] = good["Panels"]["backscatter"].pop("lobe_gain")
    assert not schema.is_valid(good)


GOOD = {
    "optics": {"width": 4, "height": 3, "fov_deg": 20},
    "lidar_equation": {"reference_reflectance": 0.8, "reference_range_m": 100},
    "footprint": {"divergence_mrad": 3},
    "noise": [{"type": "range_gaussian", "sigma_m": 0.01}, {"type": "kinect_v1"}],
}


def changed(path, value):
    """GOOD with a value replaced, or removed where it is None."""
    broken = copy.deepcopy(GOOD)
    part = broken
    for key in path[:-1]:
        part = part.setdefault(key, {}) if isinstance(part, dict) else part[key]
    if value is None:
        del part[path[-1]]
    else:
        part[path[-1]] = value
    return broken


def test_a_short_sensor_is_valid(sensor_schema):
    sensor_schema.validate(GOOD)
    glidar.Sensor.from_dict(GOOD)


@pytest.mark.parametrize(
    "path, value",
    [
        (["optics"], None),
        (["optics", "width"], None),
        (["optics", "width"], 0),
        (["optics", "width"], 4.5),
        (["optics", "widht"], 4),
        (["optics", "fov_deg"], None),
        (["optics", "fov_deg"], 180),
        (["optics", "fov_x_deg"], 20),
        (["optics", "type"], "pinhoel"),
        (["optics", "distortion"], {"model": "fisheye", "p1": 1}),
        (["optics"], {"type": "spinning", "elevation_deg": [1, 2]}),
        (["optics"], {"type": "line_scan", "azimuth_deg": {"from": 1, "to": 2}}),
        (["optics"], {"type": "prism", "pulse_hz": 1, "prisms": []}),
        (["limits"], {"near_m": -1}),
        (["light"], {"ambient": 0.1}),
        (["projector_origin_m"], [0, 0, 1]),
        (["lidar_equation"], None),
        (["lidar_equation", "overlap"], [[1, 2, 3]]),
        (["footprint", "divergence_mrad"], [1, 2, 3]),
        (["footprint", "width_definition"], "hwhm"),
        (["receiver"], {"returns": ["strongst"]}),
        (["receiver"], {"returns": 17}),
        (["noise", 0, "type"], "range_gausian"),
        (["noise", 0, "sigma"], 1),
        (["noise", 0], {"type": "range_quantization"}),
        (["cull_back_faces"], "yes"),
    ],
    ids=str,
)
def test_errors_are_found_by_the_schema_and_by_the_reader(sensor_schema, path, value):
    broken = changed(path, value)
    assert not sensor_schema.is_valid(broken)
    with pytest.raises(glidar.Error):
        glidar.Sensor.from_dict(broken)


SCENES = [path for path in sorted((ROOT / "examples").glob("*.yaml")) if "\nmodels:" in path.read_text(encoding="utf-8")]
CORPUS = [zipfile.Path(ROOT / "tests/fuzz/corpus/scene.zip", name) for name in ("models", "motion", "rig")]
#: Blocks of documentation that are scene files.
DOCUMENTED = [
    (page, block)
    for page in sorted((ROOT / "docs").rglob("*.md"))
    for block in re.findall(r"```yaml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    if re.search(r"^models:", block, re.MULTILINE)
]


@pytest.fixture(scope="module")
def scene_schema():
    return validator("scene")


@pytest.mark.parametrize("path", SCENES + CORPUS, ids=lambda path: path.stem)
def test_scene_files_are_valid(scene_schema, path):
    scene_schema.validate(load(path))


@pytest.mark.parametrize("page, block", DOCUMENTED, ids=lambda part: part.stem if isinstance(part, Path) else "block")
def test_scenes_in_the_documentation_are_valid(scene_schema, page, block):
    scene_schema.validate(yaml.load(block, Loader=Loader))  # noqa: S506 (a safe loader)


def test_there_are_scenes_to_check():
    assert len(SCENES) == 6
    assert len(DOCUMENTED) >= 4


@pytest.mark.parametrize("preset", glidar.sensor_names())
def test_presets_are_valid_as_a_part_of_a_scene(scene_schema, preset):
    sensor = json.loads(json.dumps(glidar.load_sensor(preset).to_dict()))
    scene_schema.validate({"models": [{"model": "builtin:box"}], "sensor": sensor})


SCENE = {
    "models": [
        {
            "model": "builtin:box",
            "name": "plate",
            "unit": "mm",
            "up": "y",
            "centre": True,
            "size": [2, 1, 0.5],
            "scale": 2,
            "pose": {"position": [1, 2, 3], "orientation": {"w": 1, "x": 0, "y": 0, "z": 1}},
            "id": 7,
            "class": "target",
            "materials": {"*": {"diffuse": [0.5, 0.5, 0.5]}},
            "motion": {"tumbling": {"moments_kg_m2": [1, 2, 2.5], "rate_deg_s": [1, 2, 3], "principal": {"position": [0, 0, 1]}}},
        },
        {"model": "builtin:sphere", "radius": 2, "scale": [1, 2, 3], "pose": {"rotation_vector": [0, 0, 1]},
         "motion": {"twist": {"velocity_m_s": [1, 0, 0], "frame": "world"}}},
        {"model": "builtin:torus", "radius": 2, "tube_radius": 0.1, "motion": {"spin": {"rate_rad_s": [0, 0, 1]}},
         "pose": {"matrix": [1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7]}},
    ],
    "sensors": [
        {"name": "lidar", "sensor": "VLP-16", "pose": {"euler_deg": {"yaw": 90}}},
        {"name": "camera", "sensor": {"optics": {"width": 4, "height": 3, "fov_deg": 20}}},
    ],
    "rig_pose": {"position": [0, 0, 9]},
    "rig_motion": {"twist": {"rate_deg_s": [0, 0, 1]}},
}
SINGLE = {
    "models": [{"model": "builtin:box"}],
    "sensor": "VLP-16",
    "sensor_pose": {"look_at": {"eye": [9, 0, 0], "target": [0, 0, 0]}},
    "sensor_motion": {"spin": {"rate_deg_s": [0, 0, 1]}},
}


def changed_scene(scene, path, value):
    """The scene with a value replaced, or removed where it is None."""
    broken = copy.deepcopy(scene)
    part = broken
    for key in path[:-1]:
        part = part[key] if isinstance(part, list) else part.setdefault(key, {})
    if value is None:
        del part[path[-1]]
    else:
        part[path[-1]] = value
    return broken


@pytest.mark.parametrize("scene", [SCENE, SINGLE], ids=["rig", "single"])
def test_scenes_with_all_keys_are_valid_and_survive_pickling(scene_schema, scene):
    scene_schema.validate(scene)
    loaded = glidar.Scene.from_dict(scene)
    assert pickle.loads(pickle.dumps(loaded)) == loaded
    assert glidar.Scene.from_dict(json.loads(json.dumps(scene))) == loaded
    assert list(loaded.rig) == [one["name"] for one in scene.get("sensors", [{"name": ""}])]


@pytest.mark.parametrize(
    "scene, path, value",
    [
        (SCENE, ["models"], None),
        (SCENE, ["models"], []),
        (SCENE, ["model"], "builtin:box"),
        (SCENE, ["models", 0, "model"], None),
        (SCENE, ["models", 0, "modle"], "a"),
        (SCENE, ["models", 0, "unit"], "inch"),
        (SCENE, ["models", 0, "up"], "w"),
        (SCENE, ["models", 0, "centre"], 1),
        (SCENE, ["models", 0, "size"], [1, 2, 0]),
        (SCENE, ["models", 0, "scale"], 1e16),
        (SCENE, ["models", 0, "scale"], [1, 2]),
        (SCENE, ["models", 0, "id"], -1),
        (SCENE, ["models", 0, "id"], 4294967295),
        (SCENE, ["models", 0, "materials"], [1]),
        (SCENE, ["models", 0, "materials", "*", "difuse"], [1, 1, 1]),
        (SCENE, ["models", 0, "pose", "orientation"], [1, 0, 0, 0]),
        (SCENE, ["models", 0, "pose", "orientation"], {"w": 1, "x": 0, "y": 0}),
        (SCENE, ["models", 0, "pose", "euler_deg"], {"yaw": 1}),
        (SCENE, ["models", 0, "pose", "position"], [1, 2]),
        (SCENE, ["models", 0, "pose", "look_at"], {"eye": [1, 2, 3], "target": [0, 0, 0]}),
        (SCENE, ["models", 2, "pose", "matrix"], [1, 0, 0]),
        (SCENE, ["models", 2, "pose", "position"], [1, 0, 0]),
        (SCENE, ["models", 0, "motion"], {}),
        (SCENE, ["models", 0, "motion", "spin"], {"rate_deg_s": [1, 0, 0]}),
        (SCENE, ["models", 0, "motion", "tumbling", "rate_deg_s"], None),
        (SCENE, ["models", 0, "motion", "tumbling", "rate_rad_s"], [1, 0, 0]),
        (SCENE, ["models", 0, "motion", "tumbling", "moments_kg_m2"], [1, 2, 0]),
        (SCENE, ["models", 1, "motion", "twist", "frame"], "wrld"),
        (SCENE, ["models", 1, "motion"], {"trajectory": {"rate_hz": 1}}),
        (SCENE, ["sensors"], []),
        (SCENE, ["sensors", 0, "name"], None),
        (SCENE, ["sensors", 1, "sensor", "optics", "widht"], 4),
        (SCENE, ["sensor"], "VLP-16"),
        (SCENE, ["sensors"], None),
        (SINGLE, ["rig_pose"], {}),
        (SINGLE, ["sensor"], ["VLP-16"]),
        (SINGLE, ["sensor_pose", "position"], [0, 0, 0]),
        (SINGLE, ["sensor_pose", "look_at", "target"], None),
    ],
    ids=str,
)
def test_errors_in_scenes_are_found_by_the_schema_and_by_the_reader(scene_schema, scene, path, value):
    broken = changed_scene(scene, path, value)
    assert not scene_schema.is_valid(broken)
    with pytest.raises(glidar.Error):
        glidar.Scene.from_dict(broken)


def test_parts_of_scenes_have_schemas_of_their_own():
    poses, motions = validator("pose"), validator("motion")
    for model in SCENE["models"]:
        poses.validate(model["pose"])
        motions.validate(model["motion"])
    assert not poses.is_valid({"positon": [0, 0, 0]})
    assert not motions.is_valid({"spin": {}})


#: Of every kind of optics: keys that documents may have, each with a value that fits the others. A value is a list of
#: alternatives; documents have any subset of the keys.
PRISM = {"rotation_hz": 100, "apex_deg": 10, "refractive_index": 1.5}
FACE = {"rotation_hz": 100, "tilt_deg": 10, "refractive_index": 1.5}
OPTICS = {
    "pinhole": {"calibration_file": ["camera.yaml"], "width": [8], "height": [6], "fov_deg": [20], "fov_x_deg": [30],
                "fx": [9], "fy": [9], "cx": [3],
                "distortion": [{"model": "equirectangular"}, {"model": "eucm", "alpha": 0.5, "beta": 1}, {"model": "fov"}]},
    "spinning": {"calibration_file": ["ouster.json"], "fire_time_file": ["times.csv"], "elevation_deg": [[1, 2]],
                 "columns_per_turn": [8], "firing_period_us": [50], "azimuth_left_deg": [1], "azimuth_right_deg": [1],
                 "azimuth_range": [{"from_deg": 1, "to_deg": 9}, {"from_deg": 1}, {"from_rad": 1, "width_rad": 1},
                                   {"from_rad": 1, "to_deg": 9}, {}]},
    "line_scan": {"lines": ["vertical"], "elevation_deg": [5, {"from": 0, "to": 1}], "azimuth_deg": [[1, 2], []],
                  "point_us": [1], "line_us": [9], "bidirectional": [True]},
    "prism": {"pulse_hz": [1e4], "prisms": [[PRISM], [], [{"apex_deg": 10}]], "incidence_deg": [[1, 2]],
              "incidence_roll_deg": [1]},
    "wedge_mirror": {"pulse_hz": [1e4], "first_pulse_us": [1], "incidence_deg": [[-60]], "wedge": [FACE, {"tilt_deg": 1}],
                     "mirror": [FACE]},
    "table": {"file": ["rays.csv"], "rows": [1], "point_us": [5]},
    "ouster": {"file": ["ouster.json"], "rows": [1]},
}


@pytest.fixture
def optics_files(tmp_path, monkeypatch):
    """The calibrations have all numbers of their optics: no schema knows the content of a file."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "camera.yaml").write_text("cam0: {camera_model: pinhole, intrinsics: [9, 9, 4, 3], resolution: [8, 6]}")
    (tmp_path / "ouster.json").write_text(json.dumps({
        "lidar_mode": "512x10", "prod_line": "OS-1-64", "beam_altitude_angles": [2, 1], "beam_azimuth_angles": [1, 1]}))
    (tmp_path / "times.csv").write_text("Channel,fire time(us)\n1,1\n2,2\n")
    (tmp_path / "rays.csv").write_text("Time/s,Azimuth/deg,Zenith/deg\n0,1,90\n0.001,2,90\n")


def is_read(document):
    try:
        glidar.Sensor.from_dict(document)
    except glidar.Error:
        return False
    return True


@pytest.mark.parametrize("kind", OPTICS)
@pytest.mark.usefixtures("optics_files")
def test_schema_and_reader_accept_the_same_documents(sensor_schema, kind):
    accepted = {True: 0, False: 0}
    for values in itertools.product(*([None, *values] for values in OPTICS[kind].values())):
        given = {key: value for key, value in zip(OPTICS[kind], values, strict=True) if value is not None}
        if {"calibration_file", "elevation_deg"} <= given.keys() and not {"columns_per_turn", "firing_period_us"} & given.keys():
            continue  # a calibration beside elevations replaces these only: the reader demands the time between columns
        document = {"optics": {"type": kind, **given}}
        is_valid = sensor_schema.is_valid(document)
        assert is_valid == is_read(document), document
        accepted[is_valid] += 1
    assert min(accepted.values()) > 0


def test_the_documents_have_every_kind_of_optics(sensor_schema):
    kinds = {one["properties"]["type"]["const"] for one in sensor_schema.schema["else"]["properties"]["optics"]["oneOf"]}
    assert kinds == set(OPTICS)
