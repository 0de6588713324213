# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Sensor files of a campaign, and the sensor properties that a plan needs."""

import os
from dataclasses import dataclass
from pathlib import Path

from glidar import Error, _core
from glidar.campaign import loading


@dataclass(frozen=True)
class SensorProperties:
    boresight: str = "z"  # "x" or "z": the axis along which it looks
    beams: int = 0  # number of beams of a frame


def find(name, folder):
    """The path of a sensor file and the name of its variant or "": relative to the campaign file, or of a preset."""
    beside, mark, variant = name.rpartition("#")
    is_file = os.path.isfile(Path(folder) / name)  # false too for names that the system refuses, such as long ones
    if mark and not is_file and beside.endswith((".yaml", ".yml")):
        return Path(folder) / beside, variant
    if is_file or name.endswith((".yaml", ".yml")):
        return Path(folder) / name, ""
    path, variant = _core.sensor_file(name)
    return Path(path), variant


def load(source):
    """The sensor of an input that was read."""
    return loading.load_sensor(source.text, source.path, (), source.variant, source.mode)


def properties_of(source):
    """The properties of a sensor; defaults for a sensor that cannot be read, whose trials fail."""
    if source.error:
        return SensorProperties()
    try:
        sensor = load(source)
    except Error:
        return SensorProperties()
    return SensorProperties(sensor.boresight, sensor.rows * sensor.cols)
