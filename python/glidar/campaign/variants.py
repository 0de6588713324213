# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Scene and sensor files with some values replaced.

Values are replaced in the text, so that line numbers, comments and everything else stay the same, and an error in the
changed file refers to the right line of the user's file.
"""

import os
import re
from dataclasses import dataclass
from pathlib import Path

from glidar import _core
from glidar._errors import excerpt
from glidar.campaign import yaml_file as yf

PATH = re.compile(r"(scene|sensor)((?:\.[A-Za-z_]\w*|\[[^\[\]]+\])+)")
STEP = re.compile(r"\.([A-Za-z_]\w*)|\[([^\[\]]+)\]")
MAX_DIGITS = 9  # of an element's index
# keys whose values may be paths
FILE_KEYS = {"model", "file", "sensor", "imu", "trajectory", "times", "poses", "noise_texture", "picture", "calibration_file",
             "fire_time_file", "sensor_calibration_file", "sensor_fire_time_file"}


@dataclass(frozen=True)
class Target:
    """A value of the scene or sensor file: "sensor.noise[0].sigma_m"."""

    of: str  # "scene" or "sensor"
    steps: tuple  # keys, and indices or names of list elements


def read_target(field, path):
    """Parses a dotted path; `field` is its location for errors."""
    match = PATH.fullmatch(path)
    if not match:
        yf.reject(field, f"'{excerpt(path)}'", "scene.KEY or sensor.KEY, e.g. sensor.noise[0].sigma_m, "
                  "scene.models[rock].scale")
    steps = [key or f"[{index}]" for key, index in STEP.findall(match[2])]
    return Target(match[1], tuple(steps))


def _element(field, word):
    """The element of a list with an index from 0, or a name."""
    elements = yf.items(field, 0)
    if word.isdecimal():
        if len(word) > MAX_DIGITS or int(word) >= len(elements):
            yf.reject(field, f"there is no element [{excerpt(word)}]", f"[0] to [{len(elements) - 1}]")
        return elements[int(word)]
    names = []
    for element in elements:
        found = yf.entries(element) if yf.is_map(element) else {}
        names.append(found["name"].value if "name" in found else "")
        if names[-1] == word:
            return element
    known = [name for name in names if name]
    return yf.reject(field, f"no element has the name '{excerpt(word)}'", ", ".join(known) or "[0], [1], ...",
                     yf.did_you_mean(word, known))


def _require_unanchored(field):
    """Rejects values with an anchor, which may occur at several places and would change at all of them."""
    if field.has_anchor_alias_or_tag():
        yf.reject(field, "an anchor, an alias or a tag", "a plain value", "write it out")


def find(field, target, is_replaced=True, layers=()):
    """The value that a target refers to; raises Error when the file does not contain it, or its text cannot be
    replaced. `layers` are maps of overrides, of which the first one with the value has precedence over the file."""
    field = next((layer for layer in layers if _has(layer, target)), field)
    for step in target.steps:
        if step.startswith("["):
            field = _element(field, step[1:-1])
        else:
            field = _entry(field, step)
        if is_replaced:
            _require_unanchored(field)
    return field


def _has(field, target):
    """Whether a map of overrides has the value, or replaces a list or value that contains it."""
    for step in target.steps:
        if step.startswith("[") or not yf.is_map(field):
            return True
        found = yf.entries(field)
        if step not in found:
            return False
        field = found[step]
    return True


def _entry(field, key):
    found = yf.entries(field)
    if key not in found:
        yf.reject(field, f"there is no key '{excerpt(key)}'", ", ".join(found) or "no key",
                  yf.did_you_mean(key, list(found))
                  or "add it to the file with its default value, so that it can be varied")
    return found[key]


def files_of(field):
    """The files that a scene or sensor file may name, as (field, key, path), each place of the text once; they need
    not exist."""
    folder = Path(field.file).parent
    stack, found, seen = [field], [], set()
    while stack:
        here = stack.pop()
        place = here.kind, here.position
        if place in seen:  # visited before through an alias
            continue
        if yf.is_map(here):
            seen.add(place)
            for key, value in yf.entries(here).items():
                if key in FILE_KEYS and _is_path(value.value):
                    found.append((value, key, Path(os.path.realpath(folder / value.value))))
                stack.append(value)
        elif here.kind == "list":
            seen.add(place)
            stack += yf.items(here, 0)
    return sorted(found, key=lambda entry: entry[0].position)


def _is_path(text):
    return text and "\0" not in text and not text.startswith("builtin:")


def replaced(text, field, values, layers=()):
    """The text with values replaced, given as pairs (Target, text); `layers` as for find()."""
    return _core.with_values(text, [(find(field, target, layers=layers), value) for target, value in values])


def number_text(value):
    """The shortest digits that represent the value exactly."""
    return repr(float(value)) if float(value) != int(value) else str(int(value))
