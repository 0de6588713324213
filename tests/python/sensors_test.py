# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Sensors by name, from files and of numbers."""

import json
from pathlib import Path

import numpy as np
import pytest
import yaml
from conftest import ROOT

import glidar


def test_every_preset_loads_and_describes_itself():
    names = glidar.sensor_names()
    assert len(names) >= 34
    for name in names:
        sensor = glidar.load_sensor(name)
        told = sensor.describe()
        assert (told["rows"], told["cols"]) == (sensor.rows, sensor.cols)
        assert told["name"] == sensor.name
        assert sensor.directions.shape == (sensor.rows, sensor.cols, 3)


def test_numbers_of_a_preset_have_sources():
    sheet = glidar.datasheet("VLP-16")
    assert any(entry.key.startswith("optics.") and entry.source for entry in sheet)


def test_a_dict_is_the_same_as_the_file_with_its_keys(tmp_path):
    yaml = pytest.importorskip("yaml")
    for name in ("VLP-16", "Livox-Mid-40", "Kinect-v2"):
        keys = yaml.safe_load((ROOT / f"sensors/{name}.yaml").read_text())
        assert glidar.Sensor.from_dict(keys).describe() == glidar.load_sensor(name).describe()


def test_the_dict_of_a_sensor_is_a_sensor_file(tmp_path):
    yaml = pytest.importorskip("yaml")
    for name in ("VLP-16", "OS1-32", "Livox-Mid-40", "Kinect-v2"):
        sensor = glidar.load_sensor(name)
        for text in (yaml.safe_dump(sensor.to_dict(), allow_unicode=True), json.dumps(sensor.to_dict())):
            (tmp_path / "sensor.yaml").write_text(text)
            assert glidar.load_sensor(tmp_path / "sensor.yaml") == sensor


def test_a_name_in_any_letters_comes_back(tmp_path):
    sensor = glidar.camera(4, 4, name='a "camera": \u00e4 \U0001f600')
    assert sensor.name == 'a "camera": \u00e4 \U0001f600'
    assert glidar.Sensor.from_dict(sensor.to_dict()) == sensor


def test_a_dict_may_hold_numpy_numbers():
    sensor = glidar.Sensor.from_dict(
        {
            "optics": {
                "type": "raster",
                "elevation_deg": np.linspace(-10, 10, 5),
                "azimuth_deg": np.linspace(-20, 20, 9, dtype=np.float32),
            },
            "noise": [{"type": "range_gaussian", "sigma_m": np.float64(0.01)}],
        }
    )
    assert (sensor.rows, sensor.cols, sensor.kind) == (5, 9, "raster")


def test_camera_is_that_of_the_command_line(tmp_path, program):
    program(
        "render", "builtin:box", "--width", 40, "--height", 30, "--fx", 50, "--cx", 18, "--cy", 14, "-o", tmp_path / "a.pcd"
    )
    told = json.loads((tmp_path / "a.pcd.json").read_text())["sensor"]
    ours = glidar.camera(40, 30, fx=50, cx=18, cy=14).describe()
    assert {key: value for key, value in told.items() if key != "world_from_sensor"} == ours


def test_ideal_sensor_has_no_noise():
    assert glidar.load_sensor("VLP-16").ground_truth().describe()["noise"] == []


def test_directions_are_those_of_the_pinhole():
    directions = glidar.camera(5, 3, fx=4.0).directions
    assert not directions.flags.writeable
    expected = np.array([(4 + 0.5 - 2.5) / 4.0, (2 + 0.5 - 1.5) / 4.0, 1.0])
    assert directions[2, 4] == pytest.approx(expected / np.linalg.norm(expected), abs=1e-15)


@pytest.mark.parametrize(
    ("make", "where", "words"),
    [
        (lambda: glidar.camera(0, 10), "sensor: optics.width", "0; allowed: a whole number from 1"),
        (lambda: glidar.camera(fov_deg=np.nan), "sensor: optics.fov_deg", "degrees above 0 and below 180"),
        (lambda: glidar.camera(fov_deg=20, fx=3.0), "sensor: optics", "given beside"),
        (lambda: glidar.camera(nosie=[]), "sensor: nosie", "did you mean 'noise'"),
        (lambda: glidar.camera(noise=[{"type": "range_gausian"}]), "sensor: noise[0].type", "range_gaussian"),
        (lambda: glidar.camera(name=object()), "sensor.name", "a object; allowed: numbers, texts"),
        (lambda: glidar.load_sensor("VLP16"), "sensor", "did you mean VLP-16"),
        (lambda: glidar.Sensor.from_dict({}), "sensor", "optics"),
    ],
)
def test_wrong_keys_and_numbers_are_told(make, where, words):
    with pytest.raises(glidar.Error) as caught:
        make()
    assert caught.value.where.startswith(where), str(caught.value)
    assert words in str(caught.value)


def test_an_image_that_does_not_fit_into_memory_is_refused():
    with pytest.raises(glidar.Error, match="this machine's memory"):
        glidar.camera(65536, 65536)


def test_an_unknown_sensor_is_told_as_the_command_line_does(tmp_path, program):
    told = program("render", "builtin:box", "--sensor", "VLP-61", "-o", tmp_path / "x.pcd", code=2)
    with pytest.raises(glidar.Error) as caught:
        glidar.load_sensor("VLP-61")
    assert str(caught.value) in told


def _compare(given, told, counted):
    """Numbers of a file against those of the description under the same keys, digit by digit."""
    if isinstance(given, dict) and isinstance(told, dict):
        for key in given.keys() & told.keys():
            _compare(given[key], told[key], counted)
    elif isinstance(given, list) and isinstance(told, list) and len(given) == len(told):
        for one, other in zip(given, told):
            _compare(one, other, counted)
    elif isinstance(told, list) and type(given) in (int, float):
        for other in told:  # one number for all channels
            _compare(given, other, counted)
    elif type(given) in (int, float) and type(told) in (int, float):
        assert repr(float(told)) == repr(float(given))
        counted.append(given)


def test_descriptions_have_the_numbers_of_the_files_of_presets_digit_by_digit():
    counted = []
    for name in glidar.sensor_names():
        given = yaml.safe_load(Path(glidar.sensor_file(name)).read_text(encoding="utf-8"))
        if given.get("footprint", {}).get("width_definition") == "fwhm":
            del given["footprint"]  # sidecars give the widths of 1/e2
        before = len(counted)
        _compare(given, glidar.load_sensor(name).describe(), counted)
        assert len(counted) > before, name
    assert len(counted) > 500
