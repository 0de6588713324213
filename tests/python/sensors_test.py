# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Sensors from presets, files and code."""

import json
import pickle
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
        described = sensor.describe()
        assert (described["rows"], described["cols"]) == (sensor.rows, sensor.cols)
        assert described["name"] == sensor.name
        assert sensor.ray_directions.shape == (sensor.rows, sensor.cols, 3)


def test_every_alias_and_mode_of_a_preset_loads():
    presets = {preset.name: preset for preset in glidar.sensor_presets()}
    assert list(presets) == glidar.sensor_names()
    ouster = presets["OS1-128"]
    assert (ouster.title, ouster.default_mode) == ("Ouster OS1-128", "1024x10")
    assert "OS1" in ouster.aliases
    assert ouster.modes == ("512x10", "1024x10", "2048x10", "512x20", "1024x20")
    assert (presets["VLP-16"].modes, presets["VLP-16"].default_mode) == ((), None)
    for preset in presets.values():
        assert glidar.load_sensor(preset.name).mode == preset.default_mode
        for alias in preset.aliases:
            assert glidar.load_sensor(alias) == glidar.load_sensor(preset.name)
        for mode in preset.modes:
            assert glidar.load_sensor(preset.name, mode=mode).mode == mode


def test_presets_are_found_by_a_part_of_their_name():
    assert [preset.name for preset in glidar.sensor_presets("hdl_")] == [
        "HDL-32E", "HDL-64E-S1", "HDL-64E-S2", "HDL-64E-S3", "HDL-64E-S3-unit-2"]
    assert [preset.name for preset in glidar.sensor_presets("velodyne vlp16")] == ["VLP-16"]
    assert glidar.sensor_presets("no such sensor") == []


@pytest.mark.parametrize(
    ("name", "full"),
    [("vlp16", "Velodyne VLP-16"), ("VLP_16", "Velodyne VLP-16"), ("os1-64", "Ouster OS1-64"), ("OS1 64", "Ouster OS1-64")],
)
def test_names_are_compared_without_case_and_punctuation(name, full):
    assert glidar.load_sensor(name).name == full


def test_a_mode_changes_the_sensor_and_survives_pickling():
    sensor = glidar.load_sensor("OS1-32", mode="512x20")
    assert (sensor.cols, sensor.rate_hz, sensor.mode) == (512, 20.0, "512x20")
    again = pickle.loads(pickle.dumps(sensor))
    assert (again, again.mode) == (sensor, "512x20")
    entries = {entry.key: entry.value for entry in glidar.datasheet("OS1-32", mode="512x20")}
    assert (entries["rate_hz"], entries["optics.columns_per_turn"]) == ("20", "512")


def test_a_file_with_variants_needs_the_name_of_one(tmp_path):
    path = tmp_path / "cams.yaml"
    path.write_text("optics: {width: 4, height: 3, fov_deg: 20}\nvariants: {A: {}, B: {optics: {width: 9}}}\n")
    assert glidar.load_sensor(f"{path}#b").cols == 9
    with pytest.raises(glidar.Error, match="a family of sensors; allowed: one of its variants: A, B"):
        glidar.load_sensor(path)


def test_values_of_a_preset_have_sources():
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


def test_names_in_any_script_survive_a_round_trip(tmp_path):
    sensor = glidar.camera(4, 4, name='a "camera": \u00e4 \U0001f600')
    assert sensor.name == 'a "camera": \u00e4 \U0001f600'
    assert glidar.Sensor.from_dict(sensor.to_dict()) == sensor


def test_a_dict_can_contain_numpy_numbers():
    sensor = glidar.Sensor.from_dict(
        {
            "optics": {
                "type": "line_scan",
                "elevation_deg": np.linspace(-10, 10, 5),
                "azimuth_deg": np.linspace(-20, 20, 9, dtype=np.float32),
            },
            "noise": [{"type": "range_gaussian", "sigma_m": np.float64(0.01)}],
        }
    )
    assert (sensor.rows, sensor.cols, sensor.kind) == (5, 9, "line_scan")


def test_camera_is_identical_to_that_of_the_command_line(tmp_path, program):
    program(
        "render", "builtin:box", "--width", 40, "--height", 30, "--fx", 50, "--cx", 18, "--cy", 14, "-o", tmp_path / "a.pcd"
    )
    described = json.loads((tmp_path / "a.glidar.json").read_text())["sensor"]
    ours = glidar.camera(40, 30, fx=50, cx=18, cy=14).describe()
    assert {key: value for key, value in described.items() if key != "world_from_sensor"} == ours


def test_ground_truth_sensor_has_no_noise():
    assert glidar.load_sensor("VLP-16").ground_truth().describe()["noise"] == []


def test_ray_directions_follow_the_pinhole_model():
    directions = glidar.camera(5, 3, fx=4.0).ray_directions
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
        (lambda: glidar.camera(name=object()), "sensor.name", "a object; allowed: numbers, strings"),
        (lambda: glidar.load_sensor("VLP17"), "sensor", "did you mean VLP-16"),
        (lambda: glidar.load_sensor("VLP-16", mode="1024x10"), "mode", "Velodyne VLP-16 has no modes"),
        (lambda: glidar.load_sensor("OS1-64", mode="1024x11"), "mode", "did you mean '1024x10'"),
        (lambda: glidar.load_sensor("OS1-64", mode=""), "mode", "None means the default mode"),
        (lambda: glidar.load_sensor("OS1-64", mode=3), "mode", "3; allowed: a string"),
        (lambda: glidar.Sensor.from_dict({}), "sensor", "optics"),
    ],
)
def test_invalid_keys_and_values_raise_an_error(make, where, words):
    with pytest.raises(glidar.Error) as caught:
        make()
    assert caught.value.where.startswith(where), str(caught.value)
    assert words in str(caught.value)


def test_an_image_that_does_not_fit_into_memory_is_rejected():
    with pytest.raises(glidar.Error, match="this machine's memory"):
        glidar.camera(65536, 65536)


def test_the_error_for_an_unknown_sensor_is_that_of_the_command_line(tmp_path, program):
    described = program("render", "builtin:box", "--sensor", "VLP-61", "-o", tmp_path / "x.pcd", code=2)
    with pytest.raises(glidar.Error) as caught:
        glidar.load_sensor("VLP-61")
    assert str(caught.value) in described


def _compare(given, described, counted):
    """Numbers of a file against those of the description under the same keys, digit by digit."""
    if isinstance(given, dict) and isinstance(described, dict):
        for key in given.keys() & described.keys():
            _compare(given[key], described[key], counted)
    elif isinstance(given, list) and isinstance(described, list) and len(given) == len(described):
        for one, other in zip(given, described):
            _compare(one, other, counted)
    elif isinstance(described, list) and type(given) in (int, float):
        for other in described:  # one number for all channels
            _compare(given, other, counted)
    elif type(given) in (int, float) and type(described) in (int, float):
        assert repr(float(described)) == repr(float(given))
        counted.append(given)


def _merge(base, overrides):
    """Merges the overrides of a variant or mode into a document."""
    for key, value in overrides.items():
        if isinstance(value, dict) and isinstance(base.get(key), dict):
            _merge(base[key], value)
        elif value is None:
            del base[key]
        else:
            base[key] = value


def test_descriptions_contain_the_exact_numbers_of_preset_files():
    counted = []
    for name in glidar.sensor_names():
        given = yaml.safe_load(Path(glidar.sensor_file(name)).read_text(encoding="utf-8"))
        _merge(given, given.pop("variants", {}).get(name, {}))
        _merge(given, given.pop("modes", {}).get(given.pop("default_mode", ""), {}))
        given.pop("aliases", None)
        if given.get("footprint", {}).get("width_definition") == "fwhm":
            del given["footprint"]  # sidecars give the widths of 1/e2
        before = len(counted)
        _compare(given, glidar.load_sensor(name).describe(), counted)
        assert len(counted) > before, name
    assert len(counted) > 500


HESAI_ANGLES = "Channel,Elevation,Azimuth\n" + "".join(f"{i},{15.2 - i},{0.1 * i}\n" for i in range(1, 33))
HESAI_TIMES = "Channel,fire time(us)\n" + "".join(f"{i},{2 * i}\n" for i in range(1, 33))


def test_calibrations_replace_the_numbers_of_a_preset_and_survive_round_trips(tmp_path):
    (tmp_path / "angles.csv").write_text(HESAI_ANGLES)
    (tmp_path / "times.csv").write_text(HESAI_TIMES)
    sensor = glidar.load_sensor("XT32", calibration=[tmp_path / "angles.csv", str(tmp_path / "times.csv")])
    optics = sensor.to_dict()["optics"]
    np.testing.assert_allclose(optics["elevation_deg"], [15.2 - i for i in range(1, 33)])
    np.testing.assert_allclose(optics["fire_time_us"], [2 * i for i in range(1, 33)])
    assert sensor.notes == []
    assert glidar.Sensor.from_dict(sensor.to_dict()) == sensor
    assert pickle.loads(pickle.dumps(sensor)) == sensor
    assert glidar.load_sensor("XT32").replace(calibration=tmp_path / "angles.csv") != sensor
    with pytest.raises(glidar.Error, match="32 channels; allowed: 16, as the sensor"):
        glidar.load_sensor("VLP-16", calibration=tmp_path / "angles.csv")
    with pytest.raises(glidar.Error, match="no such file"):
        glidar.load_sensor("XT32", calibration=tmp_path / "none.csv")


def test_metadata_without_an_origin_have_a_note(tmp_path):
    (tmp_path / "m.json").write_text(
        json.dumps({"lidar_mode": "512x10", "beam_altitude_angles": [1, 2], "beam_azimuth_angles": [1, 2]})
    )
    sensor = glidar.Sensor.from_dict({"optics": {"type": "ouster", "file": str(tmp_path / "m.json")}})
    assert [note.split(": ", 1)[1] for note in sensor.notes] == [
        "no lidar_origin_to_beam_origin_mm: 12.163 mm, the manufacturer's default for the product line"
    ]


@pytest.mark.parametrize(
    "distortion",
    [
        {"model": "omni", "xi": 1.1, "k1": -0.1},
        {"model": "double_sphere", "xi": -0.2, "alpha": 0.6},
        {"model": "eucm", "alpha": 0.6, "beta": 1.1},
        {"model": "fov", "w": 0.9},
        {"model": "equirectangular"},
        {"model": "radial_tangential", "s1": 0.01, "tau_x": 0.02},
    ],
)
def test_camera_models_round_trip(distortion):
    optics = {"type": "pinhole", "width": 16, "height": 12, "fx": 10, "fy": 11, "skew": 0.5, "distortion": distortion}
    sensor = glidar.Sensor.from_dict({"optics": optics})
    again = glidar.Sensor.from_dict(sensor.to_dict())
    assert again == sensor
    np.testing.assert_array_equal(again.ray_directions, sensor.ray_directions)
    assert sensor.K[0, 1] == 0.5
