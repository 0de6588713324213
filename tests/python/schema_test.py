# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The JSON Schemas by an independent validator."""

import copy
import json
import re
import subprocess
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


@pytest.mark.parametrize("preset", PRESETS, ids=lambda path: path.stem)
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
