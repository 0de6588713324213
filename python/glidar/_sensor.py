# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Sensors: by name, from files, and built of numbers."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _core
from ._beam_table import optics_of_table, stored_table, table_of_optics
from ._errors import Error, excerpt, shown
from ._inputs import MOST_32, FloatArray, numbers, path_of, text_of, whole
from ._state import Immutable, key_of, part, restoring, stated

_DEEPEST = 32
_MOST_WHOLE = 10**300
_KINDS = ("camera", "spinning", "raster", "prism", "table")


def _key_text(key: object) -> str:
    return key if isinstance(key, str) else shown(key)


def plain(value: object, where: str, depth: int = 0) -> object:
    """NumPy's numbers and arrays as Python's own."""
    if depth > _DEEPEST:
        raise Error(where[:80] + "...", f"more than {_DEEPEST} levels deep, or within itself", "lists and dicts")
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
    if isinstance(value, int) and abs(value) > _MOST_WHOLE:
        raise Error(where, shown(value), "whole numbers within 1e300")
    if value is None or isinstance(value, (bool, int, float)):
        return value
    raise Error(where, f"a {type(value).__name__}", "numbers, texts, lists and dicts")


class Sensor(Immutable):
    """A 3D sensor: optics, light, noise, weather, limits. It never changes; ``replace`` makes another.

    Sensors come from ``load_sensor``, ``camera`` and ``Sensor.from_dict``. Two sensors are equal when
    all their numbers and their names are, to the last bit, wherever they come from. Sensors can be
    hashed, copied and pickled; a pickled sensor needs no file.
    """

    __slots__ = ("_core",)

    def __init__(self, core: _core.Sensor) -> None:
        self._core = core

    @staticmethod
    def from_dict(description: Mapping[str, Any]) -> Sensor:
        """A sensor from the keys of a sensor file (docs/files.md): optics, noise, limits ...

        Args:
            description: as ``to_dict`` returns it. Beams of your own are optics of type "table" with
                arrays in the place of a file: ``directions`` (rows, cols, 3), of any length but 0, NaN
                where there is no beam; ``origins_m`` (rows, cols, 3); ``times_ns`` (rows, cols), rising,
                from 0 to below ``period_ns``; ``rings`` (rows, cols). All but the first may be left out.

        Raises:
            Error: names the field, what is allowed and the nearest known key.
        """
        optics = description.get("optics") if isinstance(description, Mapping) else None
        if not isinstance(optics, Mapping) or "directions" not in optics:
            return Sensor(_core.parse_sensor(_json(description)))
        others = {key: value for key, value in description.items() if key != "optics"}
        return Sensor(_core.parse_sensor(_json(others) if others else "{name: lidar}", table_of_optics(optics)))

    def to_dict(self) -> dict[str, Any]:
        """All its numbers with the keys of a sensor file: ``Sensor.from_dict(sensor.to_dict()) == sensor``.
        Without sources of numbers. Beams from a file are arrays (see ``from_dict``), copies that may be
        written to; all else is plain numbers, texts, lists and dicts, which YAML and JSON can hold."""
        told: dict[str, Any] = json.loads(self._core.document())
        table = self._core.beam_table()
        if table is None:
            return told
        return {"name": told.pop("name"), "optics": optics_of_table(table), **told}

    def replace(
        self,
        *,
        returns: int | str | Iterable[str] | None = None,
        rate_hz: float | None = None,
        columns_per_turn: int | None = None,
        visibility_m: float | None = None,
        rain_mm_h: float | None = None,
        snow_mm_h: float | None = None,
    ) -> Sensor:
        """The same sensor with other settings, as the command line's options of these names make it.

        Args:
            returns: of a pulse: names such as ["strongest", "last"], or how many of the nearest, 1 to
                16. For sensors with pulsed light.
            rate_hz: frames per second; of a spinning sensor: turns.
            columns_per_turn: of a spinning sensor, 1 to 1048576.
            visibility_m: in fog, 1 to 1e6 m; 0: no fog. For sensors with pulsed light.
            rain_mm_h: rain, 0 to 1000 mm/h; for pulsed light only.
            snow_mm_h: snow as melted water, 0 to 1000 mm/h; for pulsed light only.

        None keeps what the sensor has.

        Raises:
            Error: a number out of range, or the sensor has no such property.
        """
        settings = (returns, rate_hz, columns_per_turn, visibility_m, rain_mm_h, snow_mm_h)
        if all(setting is None for setting in settings):
            return self
        options = _core.SensorOptions()
        given = {"rate_hz": rate_hz, "visibility_m": visibility_m, "rain_mm_h": rain_mm_h, "snow_mm_h": snow_mm_h}
        for name, value in given.items():
            if value is not None:
                setattr(options, name, _number(value, name))
        if columns_per_turn is not None:
            options.columns_per_turn = _columns(columns_per_turn)
        if returns is not None:
            options.set_returns(_return_words(returns))
        return Sensor(self._core.changed(options))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sensor):
            return NotImplemented
        return self._core is other._core or self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._core.document())

    def _key(self) -> object:
        return (self._core.document(), key_of(self._core.beam_table()))

    def __getstate__(self) -> dict[str, Any]:
        core = self._core
        return stated("Sensor", document=core.document(), table=core.beam_table(), files=core.files)

    def __setstate__(self, state: dict[str, Any]) -> None:
        with restoring("Sensor", state):
            table = None if state["table"] is None else stored_table(part(state, "table", dict))
            files = [text_of(name, "files") for name in part(state, "files", list)]
            self._core = _core.parse_sensor(part(state, "document", str), table, files)

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
        """All its numbers as the sidecar files of clouds list them; what is infinite is None. ``to_dict``
        is what ``from_dict`` takes."""
        told: dict[str, Any] = json.loads(self._core.description())
        return told

    def ground_truth(self) -> Sensor:
        """The same without noise, pulsed light, weather, footprint and further returns: it reports
        the geometric truth."""
        return Sensor(self._core.ground_truth())

    def __repr__(self) -> str:
        return f"<glidar.Sensor {self.name!r}: {self.kind}, {self.rows} x {self.cols}, {self.rate_hz:g} Hz>"


def _json(description: object) -> str:
    return json.dumps(plain(description, "sensor"), ensure_ascii=False)  # YAML knows no surrogate pairs


def _number(value: object, where: str) -> float:
    """A number, which the library checks; also one that is not finite."""
    given = numbers(value, where, ())
    if given.shape != () or given.dtype.kind not in "fiu":
        raise Error(where, shown(value), "a number")
    return float(given)


def _columns(value: object) -> int:
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool):
        if abs(int(value)) < 2**63:  # the library looks closer
            return int(value)
    raise Error("columns_per_turn", shown(value), "a whole number from 1 to 1048576")


def _return_words(returns: object) -> list[str]:
    """Names of returns, or a number as the one word."""
    if isinstance(returns, str):
        return text_of(returns, "returns").split(",")
    if isinstance(returns, Iterable):
        return [text_of(name, "returns") for name in returns]
    return [str(whole(returns, "returns", MOST_32))]


def load_sensor(
    name_or_path: str | os.PathLike[str],
    *,
    returns: int | str | Iterable[str] | None = None,
    rate_hz: float | None = None,
    columns_per_turn: int | None = None,
    visibility_m: float | None = None,
    rain_mm_h: float | None = None,
    snow_mm_h: float | None = None,
) -> Sensor:
    """A sensor by the name of a preset (``sensor_names()``) or from a sensor file (YAML).

    Args:
        returns, rate_hz, columns_per_turn, visibility_m, rain_mm_h, snow_mm_h: settings that differ
            from the preset's or file's, as for ``Sensor.replace``.

    Raises:
        Error: there is no such sensor, with the nearest names; the file's line, column and field; a
            setting out of range, or one that the sensor does not have.
    """
    loaded = Sensor(_core.load_sensor(path_of(name_or_path, "sensor")))
    return loaded.replace(
        returns=returns,
        rate_hz=rate_hz,
        columns_per_turn=columns_per_turn,
        visibility_m=visibility_m,
        rain_mm_h=rain_mm_h,
        snow_mm_h=snow_mm_h,
    )


#: The same function, as short as ``camera``: ``glidar.sensor("VLP-16", returns=["strongest", "last"])``.
sensor = load_sensor


def sensor_file(name: str) -> str:
    """The path of the file of a preset.

    Raises:
        Error: there is no preset of this name, with the nearest names.
    """
    return os.fspath(_core.sensor_file(path_of(name, "sensor")))


def sensor_names() -> list[str]:
    """Names of the presets."""
    return _core.preset_names()


@dataclass(frozen=True)
class DatasheetEntry:
    """One number of a sensor file and where it comes from."""

    key: str
    value: str
    source: str
    """Empty: the file does not tell."""
    verified: bool
    """Against the maker's documents."""


def datasheet(name_or_path: str | os.PathLike[str]) -> list[DatasheetEntry]:
    """Every number of a preset or sensor file with its source, in the order of the file."""
    return [DatasheetEntry(*entry) for entry in _core.datasheet(path_of(name_or_path, "sensor"))]


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
    """A depth camera: a pinhole of width x height pixels.

    Args:
        fov_deg: vertical field of view; 20 when no focal length is given. Or:
        fx, fy: focal lengths in pixels; one of them: square pixels.
        cx, cy: principal point in pixels; the middle when not given.
        distortion: as in sensor files.
        others: further keys of a sensor file: noise, limits, name, rate_hz, projector_origin_m ...

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
    return Sensor.from_dict({"optics": optics, **others})
