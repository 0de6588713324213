# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Loads scenes and sensors from the texts of their files, in which values may be replaced."""

import numpy as np

import glidar
from glidar import Error, _core
from glidar._recipe import Recipe
from glidar.campaign import families, variants, yaml_file as yf

MAX_FIT_ERROR = 1e-9  # of a pinhole's directions, as tangents


def load_scene(text, path, changes=()):
    """The scene of the file at `path`, whose content is `text`, with changes."""
    if changes:
        text = variants.replaced(text, yf.parse(text, path), changes)
    return glidar.Scene._from_recipe(Recipe.of_content(text, str(path)))


def load_sensor(text, path, changes=(), variant="", mode=""):
    """The same for a sensor; `variant` and `mode` of a file that has several, or empty."""
    if changes:
        field = yf.parse(text, path)
        text = variants.replaced(text, field, changes, families.layers_of(field, variant, mode))
    return glidar.Sensor(_core.load_sensor_content(str(path), text, variant, mode))


def intrinsics_of(sensor, name):
    """The 3 x 3 camera matrix from the ray directions, with pixel centres at integers (as in OpenCV and BOP);
    raises Error for anything but a pinhole camera without distortion."""
    wrong = Error(f"sensor {name}", f"a {sensor.kind}" if sensor.kind != "camera" else
                  "a camera with distortion", "for BOP a pinhole camera without distortion", "")
    if sensor.kind != "camera" or sensor.returns != 1 or min(sensor.rows, sensor.cols) < 2:
        raise wrong
    x, y = sensor.ray_directions[..., 0] / sensor.ray_directions[..., 2], (
        sensor.ray_directions[..., 1] / sensor.ray_directions[..., 2])
    fx = (sensor.cols - 1) / (x[0, -1] - x[0, 0])
    fy = (sensor.rows - 1) / (y[-1, 0] - y[0, 0])
    k = np.array([[fx, 0.0, -fx * x[0, 0]], [0.0, fy, -fy * y[0, 0]], [0.0, 0.0, 1.0]])
    fit_x = (np.arange(sensor.cols) - k[0, 2]) / fx
    fit_y = (np.arange(sensor.rows) - k[1, 2]) / fy
    if not (np.abs(x - fit_x).max() < MAX_FIT_ERROR and np.abs(y - fit_y[:, None]).max() < MAX_FIT_ERROR):
        raise wrong
    return k


def canvas_camera(sensor, k):
    """A pinhole camera of three times the width and height, with the sensor's image in its centre."""
    return glidar.Sensor.from_dict({
        "optics": {"type": "pinhole", "width": 3 * sensor.cols, "height": 3 * sensor.rows,
                   "fx": k[0, 0], "fy": k[1, 1], "cx": k[0, 2] + sensor.cols,
                   "cy": k[1, 2] + sensor.rows, "pixel_centre": 0}})
