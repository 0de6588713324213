# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Settings of presets are identical to those of the command line: same bytes, same errors."""

import numpy as np
import pytest

import glidar

CASES = {
    "returns by name": ("VLP-16", {"returns": ["strongest", "last"]}, ["--returns", "strongest,last"]),
    "returns as text": ("VLP-16", {"returns": "first,last"}, ["--returns", "first,last"]),
    "number of returns": ("VLP-16", {"returns": 3}, ["--returns", "3"]),
    "rate": ("VLP-16", {"rate_hz": 20.0}, ["--rate", "20"]),
    "columns": ("OS1-32", {"columns_per_turn": 300}, ["--columns-per-turn", "300"]),
    "fog": ("VLP-16", {"visibility_m": 77.7}, ["--visibility", "77.7"]),
    "rain": ("VLP-16", {"rain_mm_per_h": 30}, ["--rain", "30"]),
    "snow": ("VLP-16", {"snow_mm_per_h": 2.5}, ["--snow", "2.5"]),
    "all": (
        "OS1-32",
        {"returns": 2, "rate_hz": 5, "columns_per_turn": 256, "visibility_m": 50, "rain_mm_per_h": 20,
         "snow_mm_per_h": 1},
        "--returns 2 --rate 5 --columns-per-turn 256 --visibility 50 --rain 20 --snow 1".split(),
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_a_setting_is_byte_identical_to_the_command_lines_option(case, tmp_path, program):
    name, settings, options = CASES[case]
    program("render", "builtin:asteroid", "--sensor", name, "--seed", 3, "-o", tmp_path / "theirs.npz", *options)
    scene = glidar.Scene("builtin:asteroid")
    sensor = glidar.sensor(name, **settings)
    glidar.simulate(scene, sensor, seed=3).save(tmp_path / "ours.npz")
    assert (tmp_path / "ours.npz").read_bytes() == (tmp_path / "theirs.npz").read_bytes()
    assert glidar.load_sensor(name).replace(**settings) == sensor
    plain = glidar.load_sensor(name)
    assert sensor != plain
    assert plain.replace() is plain
    assert glidar.Sensor.from_dict(sensor.to_dict()) == sensor


ERRORS = {
    "unknown return": ("VLP-16", {"returns": ["strogest"]}, ["--returns", "strogest"]),
    "no return": ("VLP-16", {"returns": 0}, ["--returns", "0"]),
    "too many returns": ("VLP-16", {"returns": 17}, ["--returns", "17"]),
    "returns of a camera": ("Kinect-v2", {"returns": 2}, ["--returns", "2"]),
    "rate of zero": ("VLP-16", {"rate_hz": 0}, ["--rate", "0"]),
    "infinite rate": ("VLP-16", {"rate_hz": np.inf}, ["--rate", "inf"]),
    "rate beyond all": ("VLP-16", {"rate_hz": 1e10}, ["--rate", "1e10"]),
    "no columns": ("OS1-32", {"columns_per_turn": 0}, ["--columns-per-turn", "0"]),
    "columns of a prism": ("Livox-Mid-40", {"columns_per_turn": 9}, ["--columns-per-turn", "9"]),
    "fog beyond all": ("VLP-16", {"visibility_m": 2e6}, ["--visibility", "2e6"]),
    "fog too thick": ("VLP-16", {"visibility_m": 0.5}, ["--visibility", "0.5"]),
    "rain below zero": ("VLP-16", {"rain_mm_per_h": -1}, ["--rain=-1"]),
    "snow that is no number": ("VLP-16", {"snow_mm_per_h": np.nan}, ["--snow", "nan"]),
    "weather of a camera": ("Kinect-v2", {"rain_mm_per_h": 1}, ["--rain", "1"]),
}
NAMES = {
    "--returns": "returns",
    "--rate": "rate_hz",
    "--columns-per-turn": "columns_per_turn",
    "--visibility": "visibility_m",
    "--rain": "rain_mm_per_h",
    "--snow": "snow_mm_per_h",
}


@pytest.mark.parametrize("case", ERRORS)
def test_errors_match_the_command_line_except_for_the_arguments_name(case, tmp_path, program):
    name, settings, options = ERRORS[case]
    printed = program("render", "builtin:box", "--sensor", name, "-o", tmp_path / "x.npz", *options, code=2)
    for option, argument in NAMES.items():
        printed = printed.replace(f"{option}:", f"{argument}:")
    with pytest.raises(glidar.Error) as error:
        glidar.sensor(name, **settings)
    assert str(error.value) in printed


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"rate_hz": "fast"}, "rate_hz: 'fast'; allowed: a number"),
        ({"rain_mm_per_h": [1, 2]}, r"rain_mm_per_h: \[1, 2\]; allowed: a number"),
        ({"columns_per_turn": 7.5}, "columns_per_turn: 7.5; allowed: a whole number from 1 to 1048576"),
        ({"columns_per_turn": 2**80}, "columns_per_turn: 12.*; allowed: a whole number from 1 to 1048576"),
        ({"returns": [1, 2]}, "returns: 1; allowed: a string"),
        ({"returns": 2.5}, "returns: 2.5; allowed: a whole number"),
        ({"returns": []}, "returns: 0 returns; allowed: 1 to 16 of first"),
        ({"returns": "strongest,,last"}, "returns: ''; allowed: 1 to 16 of first"),
    ],
)
def test_a_value_of_the_wrong_type_raises_an_error(settings, message):
    with pytest.raises(glidar.Error, match=message):
        glidar.sensor("VLP-16", **settings)


def test_numpy_numbers_are_accepted():
    settings = {"rate_hz": np.float32(20), "columns_per_turn": np.int64(90), "returns": np.uint8(2)}
    sensor = glidar.sensor("OS1-32", **settings)
    assert (sensor.rate_hz, sensor.returns) == (20.0, 2)
    assert sensor.cols == 90
