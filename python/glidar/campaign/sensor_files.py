# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Sensor files of a campaign, and the sensor properties that a plan needs."""

from dataclasses import dataclass
from pathlib import Path

import glidar
from glidar import Error
from glidar.campaign import loading


@dataclass(frozen=True)
class SensorProperties:
    boresight: str = "z"  # "x" or "z": the axis along which it looks
    beams: int = 0  # number of beams of a frame


def find(name, folder):
    """The path of a sensor file: relative to the campaign file, or of a preset."""
    beside = Path(folder) / name
    if beside.is_file() or name.endswith((".yaml", ".yml")):
        return beside
    return Path(glidar.sensor_file(name))


def properties_of(source):
    """The properties of a sensor; defaults for a sensor that cannot be read, whose trials fail."""
    if source.error:
        return SensorProperties()
    try:
        sensor = loading.load_sensor(source.text, source.path)
    except Error:
        return SensorProperties()
    return SensorProperties(sensor.boresight, sensor.rows * sensor.cols)
