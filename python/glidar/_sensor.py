# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Sensors: by name, from files, and built of numbers."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _core
from ._errors import Error
from ._inputs import FloatArray, path_of

_DEEPEST = 32
_KINDS = ("camera", "spinning", "raster", "prism", "table")


def plain(value: object, where: str, depth: int = 0) -> object:
    """NumPy's numbers and arrays as Python's own."""
    if depth > _DEEPEST:
        raise Error(where[:80] + "...", f"more than {_DEEPEST} levels deep, or within itself", "lists and dicts")
    if isinstance(value, Mapping):
        return {str(key): plain(part, f"{where}.{key}", depth + 1) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(part, f"{where}[{k}]", depth + 1) for k, part in enumerate(value)]
    if isinstance(value, (np.ndarray, np.generic)):
        return plain(value.tolist(), where, depth + 1)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    raise Error(where, f"a {type(value).__name__}", "numbers, texts, lists and dicts")


class Sensor:
    """A 3D sensor: optics, light, noise, weather, limits. It never changes; `replace` makes another.

    Sensors come from ``load_sensor``, ``camera`` and ``Sensor.from_dict``.
    """

    __slots__ = ("_core",)

    def __init__(self, core: _core.Sensor) -> None:
        self._core = core

    @staticmethod
    def from_dict(description: Mapping[str, Any]) -> Sensor:
        """A sensor of the keys of a sensor file (docs/files.md): optics, noise, limits ...

        Raises:
            Error: names the field, what is allowed and the nearest known key.
        """
        return Sensor(_core.parse_sensor(json.dumps(plain(description, "sensor"))))

    @property
    def name(self) -> str:
        """Its name."""
        return self._core.name

    @property
    def kind(self) -> str:
        """Of its optics: camera, spinning, raster, prism or table."""
        return _KINDS[self._core.kind]

    @property
    def rows(self) -> int:
        """Rows of a frame; with several returns the rows of each, one below the other."""
        return self._core.rows

    @property
    def cols(self) -> int:
        """Columns of a frame."""
        return self._core.cols

    @property
    def returns(self) -> int:
        """How many returns of a pulse it reports."""
        return self._core.returns

    @property
    def rate_hz(self) -> float:
        """Frames per second."""
        return self._core.rate_hz

    @property
    def frame_id(self) -> str:
        """Name of its coordinate frame."""
        return self._core.frame_id

    @property
    def boresight(self) -> str:
        """The axis along which it looks: "z" for cameras, "x" for LiDARs."""
        return "z" if self.kind == "camera" else "x"

    @property
    def directions(self) -> FloatArray:
        """Unit vectors of the beams of frame 0, (rows, cols, 3), in the sensor's frame; read-only.
        NaN where there is no beam."""
        return self._core.directions

    def _camera_info(self, what: str) -> dict[str, Any]:
        info: dict[str, Any] | None = self.describe()["camera_info"]
        if info is None:
            raise Error(what, f"the sensor is no camera but has optics of the kind {self.kind!r}", "a camera")
        return info

    @property
    def K(self) -> FloatArray:  # noqa: N802 (the field's name for it)
        """The camera matrix, 3x3, pixels: [[fx, 0, cx], [0, fy, cy], [0, 0, 1]] with the convention of
        OpenCV, ROS and Open3D, in which the first pixel's centre is (0, 0).

        Raises:
            Error: the sensor is no camera.
        """
        return np.array(self._camera_info("K")["k"]).reshape(3, 3)

    @property
    def distortion(self) -> FloatArray:
        """Distortion coefficients in OpenCV's order: k1 k2 p1 p2 k3, or with k4 k5 k6; of the model
        "equidistant", which is that of cv2.fisheye, k1 k2 k3 k4. Zeros without distortion.

        Raises:
            Error: the sensor is no camera.
        """
        return np.array(self._camera_info("distortion")["d"])

    @property
    def distortion_model(self) -> str:
        """What ``distortion`` is of, by ROS' names: "plumb_bob", "rational_polynomial" or "equidistant".

        Raises:
            Error: the sensor is no camera.
        """
        return str(self._camera_info("distortion_model")["distortion_model"])

    def describe(self) -> dict[str, Any]:
        """All its numbers, as the sidecars of clouds tell them, which is not what ``from_dict`` takes; what is
        infinite is None."""
        told: dict[str, Any] = json.loads(self._core.description())
        return told

    def ideal(self) -> Sensor:
        """The same without noise, pulsed light, weather, footprint and further returns: it reports
        the geometric truth."""
        return Sensor(self._core.ideal())

    def __repr__(self) -> str:
        return f"<glidar.Sensor {self.name!r}: {self.kind}, {self.rows} x {self.cols}, {self.rate_hz:g} Hz>"


def load_sensor(name_or_path: str | os.PathLike[str]) -> Sensor:
    """A sensor by the name of a preset (``sensor_names()``) or from a sensor file (YAML).

    Raises:
        Error: there is none, with the nearest names; or the file's line, column and field.
    """
    return Sensor(_core.load_sensor(path_of(name_or_path, "sensor")))


def sensor_file(name: str) -> str:
    """The path of the file of a preset.

    Raises:
        Error: there is no preset of this name, with the nearest names.
    """
    return os.fspath(_core.sensor_file(path_of(name, "sensor")))


def sensor_names() -> list[str]:
    """Names of the sensors that come along."""
    return _core.preset_names()


@dataclass(frozen=True)
class SheetEntry:
    """One number of a sensor file and where it comes from."""

    key: str
    value: str
    source: str
    """Empty: the file does not tell."""
    verified: bool
    """Against the maker's documents."""


def sensor_sheet(name_or_path: str | os.PathLike[str]) -> list[SheetEntry]:
    """Every number of a preset or sensor file with its source, in the order of the file."""
    return [SheetEntry(*entry) for entry in _core.sensor_sheet(path_of(name_or_path, "sensor"))]


def camera(
    width: int = 256,
    height: int = 256,
    *,
    fov_deg: float | None = None,
    fx: float | None = None,
    fy: float | None = None,
    cx: float | None = None,
    cy: float | None = None,
    distortion: Mapping[str, Any] | None = None,
    **sensor: Any,
) -> Sensor:
    """A depth camera: a pinhole of width x height pixels.

    Args:
        fov_deg: vertical field of view; 20 when no focal length is given. Or:
        fx, fy: focal lengths in pixels; one of them: square pixels.
        cx, cy: principal point in pixels; the middle when not given.
        distortion: as in sensor files.
        sensor: further keys of a sensor file: noise, limits, name, rate_hz, projector_m ...

    Raises:
        Error: names the field.
    """
    optics: dict[str, Any] = {"type": "pinhole", "width": width, "height": height}
    if fx is None and fy is None and fov_deg is None:
        fov_deg = 20.0
    if fx is not None or fy is not None:
        fx, fy = (fy if fx is None else fx), (fx if fy is None else fy)
    given = {"fov_deg": fov_deg, "fx": fx, "fy": fy, "cx": cx, "cy": cy, "distortion": distortion}
    optics.update({key: value for key, value in given.items() if value is not None})
    return Sensor.from_dict({"optics": optics, **sensor})
