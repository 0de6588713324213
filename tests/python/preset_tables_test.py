# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The beams of spinning presets against the tables of angles and firing times of their manufacturers and drivers.

The tables are CSV files in the folder reference/presets beside GLIDAR_DATA; they are not part of the project.
"""

import csv
import os
from pathlib import Path

import numpy as np
import pytest

import glidar

TABLES = Path(os.environ.get("GLIDAR_DATA") or "/nonexistent").parent / "reference/presets"

# table: presets with its beams
PRESETS = {
    "hesai_AT128": ["AT128"],
    "hesai_JT128": ["JT128"],
    "hesai_JT16": ["JT16"],
    "hesai_OT128": ["OT128"],
    "hesai_Pandar128E3X": ["Pandar128"],
    "hesai_Pandar40P": ["Pandar40P"],
    "hesai_Pandar64": ["Pandar64"],
    "hesai_PandarQT": ["QT64"],
    "hesai_PandarXT-16": ["XT16"],
    "hesai_XT32M2X": ["XT32M"],
    "ouster_OS0-128-rev7": ["OS0-128-rev7"],
    "ouster_OS0-32-U0": ["OS0-32-U0"],
    "ouster_OS1-128-rev7": ["OS1-128-rev7"],
    "ouster_OS1-16-A0": ["OS1-16-gen1"],
    "ouster_OS1-32-U0": ["OS1-32-U0"],
    "ouster_OS1-64-AH": ["OS1-64-AH"],
    "ouster_OS1-64-gen1": ["OS1-64-gen1"],
    "ouster_OS2-128-rev7": ["OS2-128-rev7"],
    "ouster_OS2-32-U0": ["OS2-32-U0"],
    "robosense_RS-Airy-96_fire_times": ["RS-Airy"],
    "robosense_RS-Bpearl": ["RS-Bpearl"],
    "robosense_RS-Helios-32_fire_times": ["RS-Helios-32"],
    "robosense_RS-LiDAR-16": ["RS-LiDAR-16"],
    "robosense_RS-LiDAR-32": ["RS-LiDAR-32"],
    "robosense_RS-Ruby-128_fire_times": ["RS-Ruby-128"],
    "robosense_RS-Ruby-Plus-128_fire_times": ["RS-Ruby-Plus-128"],
    "velodyne_HDL-64E-S1": ["HDL-64E-S1"],
    "velodyne_HDL-64E-S2.1": ["HDL-64E-S2"],
    "velodyne_HDL-64E-S3-b": ["HDL-64E-S3-unit-2"],
    "velodyne_VLP-16_vertical_origin": ["VLP-16", "Puck-LITE"],
    "velodyne_VLP-32A": ["VLP-32A"],
    "velodyne_VLP-32B": ["VLP-32B"],
}
# Directions and times are double precision; the tables have at most four decimals, which the presets repeat.
MAX_ANGLE_ERROR_DEG = 1e-6
# Firing times are whole nanoseconds.
MAX_TIME_ERROR_US = 0.0005 + 1e-9
FULL_TURN_DEG = 360.0


def rows_of(name):
    with open(TABLES / f"{name}.csv", encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def table_of(name):
    """Columns of a table as arrays by name; NaN for empty cells."""
    rows = rows_of(name)
    return {key: np.array([float(row[key] or "nan") for row in rows]) for key in rows[0] if key.endswith(("_deg", "_us"))}


def channels_of(name, column=None):
    """Elevation, azimuth to the right, and firing time of each channel as its beams have them in a column; by default in the
    middle of a frame. Channels without a beam in this column are left out.

    Azimuths and times have an arbitrary origin. The head turns between two firings: the azimuth of a channel is that of
    its beam without the rotation until it fires.
    """
    sensor = glidar.load_sensor(name).ground_truth()
    cloud = glidar.simulate(glidar.Scene("builtin:box:size=20"), sensor).cloud(["azimuth", "elevation", "time"])
    column = sensor.cols // 2 if column is None else column
    fired = np.isfinite(cloud["elevation"][:, column])
    azimuth_deg, elevation_deg = (np.degrees(cloud[key][fired, column]) for key in ("azimuth", "elevation"))
    time_us = cloud["time"][fired, column] * 1e-3
    azimuth_right_deg = -azimuth_deg - FULL_TURN_DEG * sensor.rate_hz * time_us * 1e-6
    return {"elevation_deg": elevation_deg, "azimuth_right_deg": azimuth_right_deg, "fire_time_us": time_us}


def expected_channels(table):
    """The table in the terms of channels_of(); columns that it lacks are left out."""
    channels = {key: table[key] for key in ("elevation_deg", "azimuth_right_deg", "fire_time_us") if key in table}
    if "azimuth_left_deg" in table:
        channels["azimuth_right_deg"] = -table["azimuth_left_deg"]
    return channels


def sorted_channels(channels, keys):
    """Channels in an order that does not depend on their numbers, with azimuths and times relative to their means."""
    relative = dict(channels)
    if "azimuth_right_deg" in keys:
        turned = np.exp(1j * np.radians(channels["azimuth_right_deg"]))
        relative["azimuth_right_deg"] = np.degrees(np.angle(turned / turned.mean()))
    if "fire_time_us" in keys:
        relative["fire_time_us"] = channels["fire_time_us"] - np.mean(channels["fire_time_us"])
    order = np.lexsort([np.round(relative[key], 3) for key in reversed(keys)])
    return {key: relative[key][order] for key in keys}


def assert_same_channels(found, expected, what):
    found = sorted_channels(found, list(expected))
    for key, values in sorted_channels(expected, list(expected)).items():
        tolerance = MAX_TIME_ERROR_US if key == "fire_time_us" else MAX_ANGLE_ERROR_DEG
        np.testing.assert_allclose(found[key], values, rtol=0, atol=tolerance, err_msg=f"{what}: {key}")


pytestmark = pytest.mark.skipif(not TABLES.is_dir(), reason="no tables of manufacturers beside GLIDAR_DATA; set it to a folder with real data")


@pytest.mark.parametrize("name", PRESETS)
def test_channels_have_the_angles_and_firing_times_of_the_manufacturers_table(name):
    expected = expected_channels(table_of(name))
    for preset in PRESETS[name]:
        assert_same_channels(channels_of(preset), expected, preset)


def test_the_two_firing_loops_of_the_qt128_take_turns_with_the_channels_and_times_of_its_table():
    table = table_of("hesai_QT128C2X")
    for loop in (1, 2):
        times = table[f"fire_time_loop{loop}_us"]
        fired = np.isfinite(times)
        expected = {key: table[key][fired] for key in ("elevation_deg", "azimuth_right_deg")} | {"fire_time_us": times[fired]}
        for column in (300 + loop - 1, 600 + loop - 1):
            assert_same_channels(channels_of("QT128", column), expected, f"loop {loop}, column {column}")


@pytest.mark.parametrize(
    ("preset", "model"),
    [("Leishen-C16", "C16 version 4"), ("Leishen-C16-v3", "C16 version 3"), ("Leishen-C32", "C32 version 4")],
)
def test_elevations_of_leishen_sensors_are_those_of_their_driver(preset, model):
    expected = [float(row["elevation_deg"]) for row in rows_of("leishen_C16_C32") if row["model"] == model]
    assert_same_channels(channels_of(preset), {"elevation_deg": np.array(expected)}, preset)


def test_layers_of_the_multiscan165_are_those_of_its_driver():
    expected = table_of("sick_multiScan165_layers")["elevation_up_deg"]
    assert_same_channels(channels_of("multiScan165"), {"elevation_deg": expected}, "multiScan165")
