# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Sensors: presets, sensor files and sensors defined in code."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from . import _core
from ._beam_table import optics_of_table, stored_table, table_of_optics
from ._errors import Error, excerpt, shown
from ._inputs import MAX_UINT32, FloatArray, numbers, path_of, text_of, whole
from ._presets import mode_of
from ._state import Immutable, key_of, part, restoring, make_state

_MAX_DEPTH = 32
_MAX_INTEGER = 10**300


def _key_text(key: object) -> str:
    return key if isinstance(key, str) else shown(key)


def plain(value: object, where: str, depth: int = 0) -> object:
    """Converts NumPy's numbers and arrays to Python's."""
    if depth > _MAX_DEPTH:
        raise Error(where[:80] + "...", f"more than {_MAX_DEPTH} levels deep, or recursive", "lists and dicts")
    if isinstance(value, Mapping):
        return {text_of(_key_text(key), where): plain(part, f"{where}.{excerpt(_key_text(key))}", depth + 1)
                for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(part, f"{where}[{k}]", depth + 1) for k, part in enumerate(value)]
    if isinstance(value, (np.ndarray, np.generic)):
        return plain(value.tolist(), where, depth + 1)
    if isinstance(value, os.PathLike):
        return path_of(value, where)
    if isinstance(value, str):
        return text_of(value, where)
    if isinstance(value, int) and abs(value) > _MAX_INTEGER:
        raise Error(where, shown(value), "whole numbers within 1e300")
    if value is None or isinstance(value, (bool, int, float)):
        return value
    raise Error(where, f"a {type(value).__name__}", "numbers, strings, lists and dicts")


class Sensor(Immutable):
    """A 3D sensor: optics, lidar equation, receiver, noise, weather and limits. It is immutable; ``replace``
    returns a changed copy.

    Sensors come from ``load_sensor``, ``camera`` and ``Sensor.from_dict``. Two sensors are equal when all their
    values and names are bit-identical, regardless of where they come from. Sensors can be hashed, copied and
    pickled; a pickled sensor needs no file.
    """

    __slots__ = ("_core",)

    def __init__(self, core: _core.Sensor) -> None:
        self._core = core

    @staticmethod
    def from_dict(description: Mapping[str, Any]) -> Sensor:
        """A sensor from the keys of a sensor file (docs/files.md): optics, noise, limits ...

        Args:
            description: as ``to_dict`` returns it. Optics of type "table" may have arrays instead of a file:
                ``directions`` (rows, cols, 3), sensor frame, any length but 0, NaN for no beam; ``origins_m``
                (rows, cols, 3); ``times_ns`` (rows, cols), increasing, from 0 to below ``period_ns``;
                ``rings`` (rows, cols). Only the first is required.

        Raises:
            Error: names the field, what is allowed and the nearest known key.
        """
        optics = description.get("optics") if isinstance(description, Mapping) else None
        if not isinstance(optics, Mapping) or "directions" not in optics:
            return Sensor(_core.parse_sensor(_json(description)))
        others = {key: value for key, value in description.items() if key != "optics"}
        return Sensor(_core.parse_sensor(_json(others) if others else "{name: lidar}", table_of_optics(optics)))

    def to_dict(self) -> dict[str, Any]:
        """All values with the keys of a sensor file: ``Sensor.from_dict(sensor.to_dict()) == sensor``.

        Sources of values are omitted; notes are kept. Beams from a file are arrays (see ``from_dict``), copies
        that may be modified; all else is plain numbers, strings, lists and dicts, which YAML and JSON can represent."""
        document: dict[str, Any] = json.loads(self._core.document())
        table = self._core.beam_table()
        if table is None:
            return document
        return {"name": document.pop("name"), "optics": optics_of_table(table), **document}

    def replace(
        self,
        *,
        returns: int | str | Iterable[str] | None = None,
        rate_hz: float | None = None,
        columns_per_turn: int | None = None,
        visibility_m: float | None = None,
        rain_mm_per_h: float | None = None,
        snow_mm_per_h: float | None = None,
        depth_model: str | None = None,
        calibration: str | os.PathLike[str] | Iterable[str | os.PathLike[str]] | None = None,
    ) -> Sensor:
        """The same sensor with other settings, like the command-line options of the same names.

        Args:
            returns: returns of a pulse: names such as ["strongest", "last"], or the number of nearest ones, 1 to
                16. For pulsed sensors only.
            rate_hz: frames per second; of a spinning sensor: rotations per second.
            columns_per_turn: columns per rotation of a spinning sensor, 1 to 1048576.
            visibility_m: visibility in fog, 1 to 1e6 m; 0: no fog. For pulsed sensors only.
            rain_mm_per_h: rain rate, 0 to 1000 mm/h. For pulsed sensors only.
            snow_mm_per_h: snowfall rate as melted water, 0 to 1000 mm/h. For pulsed sensors only.
            depth_model: "law" (noise steps) or "physical" (raw images). For sensors with a ``depth_camera`` only.
            calibration: calibration file of one spinning LiDAR, or several: metadata of Ouster, YAML of
                velodyne_pointcloud, angle correction and firing time CSV of Hesai. ``notes`` lists what of it is
                not used.

        None keeps the sensor's setting.

        Raises:
            Error: a number is out of range, or the sensor has no such property.
        """
        settings = (
            returns,
            rate_hz,
            columns_per_turn,
            visibility_m,
            rain_mm_per_h,
            snow_mm_per_h,
            depth_model,
            calibration,
        )
        if all(setting is None for setting in settings):
            return self
        options = _core.SensorOptions()
        given = {
            "rate_hz": rate_hz,
            "visibility_m": visibility_m,
            "rain_mm_per_h": rain_mm_per_h,
            "snow_mm_per_h": snow_mm_per_h,
        }
        for name, value in given.items():
            if value is not None:
                setattr(options, name, _number(value, name))
        if columns_per_turn is not None:
            options.columns_per_turn = _columns(columns_per_turn)
        if depth_model is not None:
            options.set_depth_model(text_of(depth_model, "depth_model"))
        if calibration is not None:
            options.calibration_files = _calibration_files(calibration)
        if returns is not None:
            options.set_returns(_return_names(returns))
        return Sensor(self._core.changed(options))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sensor):
            return NotImplemented
        return self._core is other._core or self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._core.values())

    def _key(self) -> object:
        return (self._core.values(), key_of(self._core.beam_table()))

    def __getstate__(self) -> dict[str, Any]:
        core = self._core
        return make_state(
            "Sensor",
            document=core.document(),
            table=core.beam_table(),
            files=core.files,
            variant=core.variant,
            mode=core.mode,
        )

    def __setstate__(self, state: dict[str, Any]) -> None:
        with restoring("Sensor", state):
            table = None if state["table"] is None else stored_table(part(state, "table", dict))
            files = [text_of(name, "files") for name in part(state, "files", list)]
            names = (part(state, "variant", str), part(state, "mode", str))
            self._core = _core.parse_sensor(part(state, "document", str), table, files, names)

    @property
    def name(self) -> str:
        """Name of the sensor."""
        return self._core.name

    @property
    def kind(self) -> str:
        """Type of its optics: "camera", "spinning", "line_scan", "prism" or "table"."""
        return "camera" if self._core.kind == "pinhole" else self._core.kind

    @property
    def rows(self) -> int:
        """Rows of a frame. With several returns, each return is a block of this many rows, stacked vertically."""
        return self._core.rows

    @property
    def cols(self) -> int:
        """Columns of a frame."""
        return self._core.cols

    @property
    def returns(self) -> int:
        """Number of returns of a pulse that it reports."""
        return self._core.returns

    @property
    def rate_hz(self) -> float:
        """Frames per second, Hz."""
        return self._core.rate_hz

    @property
    def mode(self) -> str | None:
        """Name of the mode in which it was loaded; None: its file has no modes."""
        return self._core.mode or None

    @property
    def notes(self) -> list[str]:
        """Defaults that its files left open, and numbers of its files that have no effect."""
        return list(self._core.notes)

    @property
    def frame_id(self) -> str:
        """Name of the sensor's coordinate frame."""
        return self._core.frame_id

    @property
    def boresight(self) -> str:
        """The axis of its coordinate frame along which it looks: "z" for cameras, "x" for LiDARs."""
        return "z" if self.kind == "camera" else "x"

    @property
    def ray_directions(self) -> FloatArray:
        """Unit vectors of the beams of frame 0, (rows, cols, 3), in the sensor's coordinate frame; read-only.
        NaN for pixels without a beam."""
        return self._core.directions

    def _camera_info(self, what: str) -> dict[str, Any]:
        info: dict[str, Any] | None = self.describe()["camera_info"]
        if info is None:
            raise Error(what, f"the sensor is not a camera; its optics have the type {self.kind!r}", "a camera")
        return info

    @property
    def K(self) -> FloatArray:  # noqa: N802 (the established symbol)
        """The camera matrix, (3, 3), pixels: [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], in the convention of
        OpenCV, ROS and Open3D, in which the first pixel's centre is (0, 0).

        Raises:
            Error: the sensor is not a camera.
        """
        return np.array(self._camera_info("K")["k"]).reshape(3, 3)

    @property
    def distortion(self) -> FloatArray:
        """Distortion coefficients in OpenCV's order: k1 k2 p1 p2 k3, with k4 k5 k6 for the model
        "rational_polynomial"; k1 k2 k3 k4 for "equidistant", the model of cv2.fisheye. Zeros without distortion.

        Raises:
            Error: the sensor is not a camera.
        """
        return np.array(self._camera_info("distortion")["d"])

    @property
    def distortion_model(self) -> str:
        """The model of ``distortion`` by its ROS name: "plumb_bob", "rational_polynomial" or "equidistant".

        Raises:
            Error: the sensor is not a camera.
        """
        return str(self._camera_info("distortion_model")["distortion_model"])

    def describe(self) -> dict[str, Any]:
        """All values as in the sidecar files of clouds; infinite values are None. ``to_dict`` returns what
        ``from_dict`` reads."""
        document: dict[str, Any] = json.loads(self._core.description())
        return document

    def ground_truth(self) -> Sensor:
        """The same sensor without noise, lidar equation, weather, footprint and additional returns. It reports
        the geometric ground truth."""
        return Sensor(self._core.ground_truth())

    def __repr__(self) -> str:
        return f"<glidar.Sensor {self.name!r}: {self.kind}, {self.rows} x {self.cols}, {self.rate_hz:g} Hz>"


def _json(description: object) -> str:
    return json.dumps(plain(description, "sensor"), ensure_ascii=False)  # YAML has no surrogate pairs


def _number(value: object, where: str) -> float:
    """A real number; the library checks its value, which may be infinite or NaN."""
    given = numbers(value, where, ())
    if given.shape != () or given.dtype.kind not in "fiu":
        raise Error(where, shown(value), "a number")
    return float(given)


def _columns(value: object) -> int:
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool):
        if abs(int(value)) < 2**63:  # the library checks the exact range
            return int(value)
    raise Error("columns_per_turn", shown(value), "a whole number from 1 to 1048576")


def _return_names(returns: object) -> list[str]:
    """Names of returns, or a number as a single string."""
    if isinstance(returns, str):
        return text_of(returns, "returns").split(",")
    if isinstance(returns, Iterable):
        return [text_of(name, "returns") for name in returns]
    return [str(whole(returns, "returns", MAX_UINT32))]


def _calibration_files(files: object) -> list[str]:
    """One path, or several."""
    if isinstance(files, (str, os.PathLike)) or not isinstance(files, Iterable):
        return [path_of(files, "calibration")]
    return [path_of(file, "calibration") for file in files]


def load_sensor(
    name_or_path: str | os.PathLike[str],
    *,
    mode: str | None = None,
    returns: int | str | Iterable[str] | None = None,
    rate_hz: float | None = None,
    columns_per_turn: int | None = None,
    visibility_m: float | None = None,
    rain_mm_per_h: float | None = None,
    snow_mm_per_h: float | None = None,
    calibration: str | os.PathLike[str] | Iterable[str | os.PathLike[str]] | None = None,
) -> Sensor:
    """A sensor by the name of a preset (``sensor_names()``), or from a sensor file (YAML).

    Args:
        name_or_path: name or alias of a preset, or path of a sensor file; ``FILE#VARIANT`` for a file with variants.
            Names are compared without case, "-", "_" and spaces.
        mode: mode of the sensor, such as "2048x10"; None: its default mode.
        returns, rate_hz, columns_per_turn, visibility_m, rain_mm_per_h, snow_mm_per_h, calibration: settings that
            replace those of the preset or file, as for ``Sensor.replace``.

    Raises:
        Error: there is no such sensor (with the nearest names) or mode (with those that exist), the file is malformed
            (with line, column and field), a setting is out of range, or the sensor does not have it.
    """
    loaded = Sensor(_core.load_sensor(path_of(name_or_path, "sensor"), mode_of(mode)))
    return loaded.replace(
        returns=returns,
        rate_hz=rate_hz,
        columns_per_turn=columns_per_turn,
        visibility_m=visibility_m,
        rain_mm_per_h=rain_mm_per_h,
        snow_mm_per_h=snow_mm_per_h,
        calibration=calibration,
    )


#: Alias of ``load_sensor``: ``glidar.sensor("VLP-16", returns=["strongest", "last"])``.
sensor = load_sensor


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
    **others: Any,
) -> Sensor:
    """A depth camera: a pinhole camera of width x height pixels.

    Args:
        fov_deg: vertical field of view, degrees; default 20 without a focal length. Or:
        fx, fy: focal lengths, pixels; if one is given, it applies to both.
        cx, cy: principal point, pixels; default: the image centre.
        distortion: distortion as in sensor files.
        others: further keys of a sensor file: noise, limits, name, rate_hz, projector_origin_m ...

    Raises:
        Error: a value is invalid; names the field.
    """
    optics: dict[str, Any] = {"type": "pinhole", "width": width, "height": height}
    if fx is None and fy is None and fov_deg is None:
        fov_deg = 20.0
    if fx is not None or fy is not None:
        fx, fy = (fy if fx is None else fx), (fx if fy is None else fy)
    given = {"fov_deg": fov_deg, "fx": fx, "fy": fy, "cx": cx, "cy": cy, "distortion": distortion}
    optics.update({key: value for key, value in given.items() if value is not None})
    return Sensor.from_dict({"optics": optics, **others})
