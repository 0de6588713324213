# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Scene and sensor files with all files that they read: their contents when the campaign was planned, and whether these
are unchanged when trials measure."""

import functools
import os
import stat
from dataclasses import dataclass
from pathlib import Path

import glidar
from glidar import Error
from glidar.campaign import files, variants, yaml_file as yf


class InputChanged(Error):
    """A file differs from the planned one. This ends the run, instead of failing one trial."""


@dataclass(frozen=True)
class InputFile:
    """A file that is read with a scene or sensor file."""

    name: str  # relative to that file's folder; as written there if it is named there
    path: Path
    hash: str | None  # SHA-256; None: it does not exist
    is_part: bool  # read by a model that is named, such as a texture


@dataclass(frozen=True)
class Input:
    """A scene or sensor file: its text, or the error when it was read."""

    name: str  # as in the campaign file
    path: Path
    text: str = ""
    error: str = ""  # why its trials fail; empty: no error is known
    files: tuple = ()  # of InputFile
    all_known: bool = False  # whether `files` lists everything that it reads
    variant: str = ""  # of a sensor file with several; empty: none is chosen
    mode: str = ""  # of a sensor; empty: its default mode

    @property
    def choice(self):
        """Arguments of loading.load_sensor; empty for scenes and sensors without."""
        return {key: value for key, value in (("variant", self.variant), ("mode", self.mode)) if value}

    def record(self):
        """What identifies it, as JSON."""
        def hashes(are_parts):
            return {f.name: f.hash for f in self.files if f.hash and f.is_part == are_parts}

        return {"name": self.name, **self.choice, "sha256": files.hash_bytes(self.text.encode()),
                "unreadable": bool(self.error), "files": hashes(False), "parts": hashes(True)}


@functools.lru_cache(maxsize=1 << 12)
def _hash_of(path, state):
    return files.hash_file(path)


def _hash(path):
    """The hash of a file, computed again only when the file changed; None: the file does not exist."""
    try:
        now = os.stat(path)
    except OSError:
        return None
    state = (now.st_dev, now.st_ino, now.st_size, now.st_mtime_ns, now.st_ctime_ns)
    return _hash_of(str(path), state) if stat.S_ISREG(now.st_mode) else None


def _read_with(spelled, path, known):
    """The other files that the loader reads with a model, as {name: path}; None when it cannot be loaded and its
    trials fail. `known` caches the loader's lists by path."""
    if path not in known:
        try:
            known[path] = glidar.Scene(path)._core.files
        except Error:
            known[path] = None
    if known[path] is None:
        return None
    beside = os.path.dirname(spelled)
    return {os.path.normpath(os.path.join(beside, os.path.relpath(other, path.parent))): Path(other)
            for other in known[path] if other != str(path)}


def read(name, path, known, variant="", mode=""):
    """Reads a scene or sensor file. An error is stored, so that only its trials fail. `known` as for _read_with."""
    try:
        text = yf.read_text(path)
        named, parts, all_known = {}, {}, True
        for field, key, found in variants.files_of(yf.parse(text, path)):
            spelled = field.value
            more = _read_with(spelled, found, known) if key == "model" else {}
            named[spelled] = found
            parts.update(more or {})
            all_known &= more is not None and key != "sensor"  # because a sensor file may name further files
        found = tuple(InputFile(one, where, _hash(where), paths is parts)
                      for paths in (named, parts) for one, where in paths.items())
        return Input(name, path, text, "", found, all_known, variant, mode)
    except Error as error:
        return Input(name, path, error=str(error), variant=variant, mode=mode)


def _require_unchanged(source, loaded):
    """Raises InputChanged when a file has changed, or a file was read that did not exist before."""
    wrong = [file.path for file in source.files if _hash(file.path) != file.hash]
    if source.all_known:
        known = {str(source.path), *(str(file.path) for file in source.files)}
        wrong += [name for name in loaded if os.path.realpath(name) not in known and name not in known]
    if wrong:
        raise InputChanged(str(wrong[0]), "it was changed while the campaign ran", "",
                      "restore it and run the same command again, or start in a new folder")


def load(source, how, changes):
    """Loads a scene or sensor with `how`, loading.load_scene or load_sensor."""
    if source.error:
        raise Error("", source.error, "", "")
    try:
        found = how(source.text, source.path, changes, **source.choice)
    except Error:
        _require_unchanged(source, [])
        raise
    _require_unchanged(source, found._core.files if isinstance(found, glidar.Scene) else [])
    return found
