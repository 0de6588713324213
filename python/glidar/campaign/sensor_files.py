# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Sensors of a campaign: where their files are, and what a plan needs to know of them."""

from dataclasses import dataclass
from pathlib import Path

import glidar
from glidar import Error
from glidar.campaign import loading


@dataclass(frozen=True)
class Look:
    boresight: str = "z"  # the axis along which it looks
    beams: int = 0  # of a frame


def find(name, folder):
    """The file of a sensor: beside the campaign file, or by the name of a preset."""
    beside = Path(folder) / name
    if beside.is_file() or name.endswith((".yaml", ".yml")):
        return beside
    return Path(glidar.sensor_file(name))


def look(source):
    """What a plan needs to know; of a sensor that cannot be read, whose trials fail, anything."""
    if source.fault:
        return Look()
    try:
        sensor = loading.load_sensor(source.text, source.path)
    except Error:
        return Look()
    return Look(sensor.boresight, sensor.rows * sensor.cols)
