# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Scene and sensor files with all that is read with them: what it held when the campaign was planned, and
whether it still does when trials measure it."""

import functools
import os
import stat
from dataclasses import dataclass
from pathlib import Path

import glidar
from glidar import Error
from glidar.campaign import files, loading, variants, yaml_file as yf


class Changed(Error):
    """A file is not what the campaign was planned with; this ends the run, and does not only fail a trial."""


@dataclass(frozen=True)
class Read:
    """A file that is read with a scene or sensor file."""

    name: str  # from that file's folder; if that file names it, as it does
    path: Path
    hash: str | None  # SHA-256; None: it is not there
    is_part: bool  # of a model that is named


@dataclass(frozen=True)
class Input:
    """A scene or sensor file: its text once read, or the fault that it has."""

    name: str  # as the campaign file spells it
    path: Path
    text: str = ""
    fault: str = ""  # why its trials fail; empty: nothing is known to be wrong
    files: tuple = ()  # of Read
    all_known: bool = False  # what it reads is in `files`, and nothing else

    def record(self):
        """What makes it what it is, as JSON."""
        def hashes(are_parts):
            return {f.name: f.hash for f in self.files if f.hash and f.is_part == are_parts}

        return {"name": self.name, "sha256": files.hash_bytes(self.text.encode()),
                "fault": bool(self.fault), "files": hashes(False), "parts": hashes(True)}


@functools.lru_cache(maxsize=1 << 12)
def _hash_of(path, state):
    return files.hash_file(path)


def _hash(path):
    """Of a file, which is read again only where it is not as it was; None: there is no such file."""
    try:
        now = os.stat(path)
    except OSError:
        return None
    state = (now.st_dev, now.st_ino, now.st_size, now.st_mtime_ns, now.st_ctime_ns)
    return _hash_of(str(path), state) if stat.S_ISREG(now.st_mode) else None


def _read_with(spelled, path, known):
    """What the loader reads of a model beside its file, as {name: path}; None where it cannot be loaded, whose
    trials fail and say why. `known` keeps the loader's lists by path."""
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


def read(name, path, known):
    """Reads a scene or sensor file; a fault is kept, so that only its trials fail. `known` as for _read_with."""
    try:
        text = yf.read_text(path)
        named, parts, all_known = {}, {}, True
        for field, key, found in variants.files_of(yf.parse(text, path)):
            spelled = field.node.value
            more = _read_with(spelled, found, known) if key == "model" else {}
            named[spelled] = found
            parts.update(more or {})
            all_known &= more is not None and key != "sensor"  # which may name files of its own
        found = tuple(Read(one, where, _hash(where), paths is parts)
                      for paths in (named, parts) for one, where in paths.items())
        return Input(name, path, text, "", found, all_known)
    except Error as error:
        return Input(name, path, fault=str(error))


def _require_unchanged(source, loaded):
    """Throws Changed where a file is not what it was, or one was read that was not there."""
    wrong = [file.path for file in source.files if _hash(file.path) != file.hash]
    if source.all_known:
        known = {str(file.path) for file in source.files}
        wrong += [name for name in loaded if name not in known and not loading.is_copy(name)]
    if wrong:
        raise Changed(str(wrong[0]), "it was changed while the campaign ran", "",
                      "put it back and run the same command again, or begin a new folder")


def load(source, how, changes):
    """Loads a scene or sensor by loading.load_scene or load_sensor."""
    if source.fault:
        raise Error("", source.fault, "", "")
    try:
        found = how(source.text, source.path, changes)
    except Error:
        _require_unchanged(source, [])
        raise
    _require_unchanged(source, found._core.files if isinstance(found, glidar.Scene) else [])
    return found
