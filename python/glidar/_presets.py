# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The sensor presets: their names, aliases and modes, and the sources of their numbers."""

from __future__ import annotations

import os
from dataclasses import dataclass

from . import _core
from ._errors import Error
from ._inputs import path_of, text_of


def mode_of(mode: str | None) -> str:
    """The mode as the library takes it: empty for the default one."""
    if mode is None:
        return ""
    given = text_of(mode, "mode")
    if not given:
        raise Error("mode", "an empty text", "the name of a mode", "None means the default mode")
    return given


def sensor_file(name: str) -> str:
    """The path of the sensor file that a preset is read from, which is that of its family for a variant.

    Raises:
        Error: there is no preset of this name; with the nearest names.
    """
    return os.fspath(_core.sensor_file(path_of(name, "sensor"))[0])


def sensor_names() -> list[str]:
    """Names of the presets."""
    return [preset.name for preset in sensor_presets()]


@dataclass(frozen=True)
class SensorPreset:
    """A bundled sensor."""

    name: str
    title: str
    """Name of the sensor with that of its manufacturer."""
    aliases: tuple[str, ...]
    """Further names."""
    modes: tuple[str, ...]
    """Names of its modes, for ``load_sensor(name, mode=...)``."""
    default_mode: str | None
    """The mode that is used if none is chosen; None: it has none."""


def sensor_presets(text: str = "") -> list[SensorPreset]:
    """The presets, sorted by name: all, or those whose name, alias or title contains the text. Case, "-", "_" and
    spaces do not count."""
    return [
        SensorPreset(name, title, tuple(aliases), tuple(modes), default or None)
        for name, title, aliases, modes, default in _core.sensor_presets(text_of(text, "text"))
    ]


@dataclass(frozen=True)
class DatasheetEntry:
    """One value of a sensor file and its source."""

    key: str
    value: str
    source: str
    """Where the value comes from; empty when the file does not state it."""
    verified: bool
    """Whether the value was checked against the manufacturer's documents."""


def datasheet(name_or_path: str | os.PathLike[str], *, mode: str | None = None) -> list[DatasheetEntry]:
    """Every value of a preset or sensor file with its source, in the order of the file; ``mode`` as for
    ``load_sensor``."""
    return [DatasheetEntry(*entry) for entry in _core.datasheet(path_of(name_or_path, "sensor"), mode_of(mode))]
