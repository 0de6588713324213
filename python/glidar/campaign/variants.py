# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Scene and sensor files with some of their values replaced.

Values are replaced in the text, where they stand, so that line numbers, comments and all else of the
file stay, and an error about the changed file points at the right line of the user's.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import yaml

from glidar.campaign import yaml_file as yf

PATH = re.compile(r"(scene|sensor)((?:\.[A-Za-z_]\w*|\[[^\[\]]+\])+)")
STEP = re.compile(r"\.([A-Za-z_]\w*)|\[([^\[\]]+)\]")
FILE_KEYS = {"model", "file", "sensor", "trajectory", "noise_texture"}  # whose texts may be paths


@dataclass(frozen=True)
class Target:
    """A value of the scene or sensor file: "sensor.noise[0].sigma_m"."""

    of: str  # "scene" or "sensor"
    steps: tuple  # keys, and indices or names of list elements


def read_target(field, path):
    """Takes a dotted path apart; `field` is what it is given for."""
    match = PATH.fullmatch(path)
    if not match:
        yf.reject(field, f"'{path}'", "scene.KEY or sensor.KEY, e.g. sensor.noise[0].sigma_m, "
                  "scene.models[rock].scale")
    steps = [key or f"[{index}]" for key, index in STEP.findall(match[2])]
    return Target(match[1], tuple(steps))


def _element(field, word):
    """The element of a list by its place from 0, or by its name."""
    elements = yf.items(field, 0)
    if word.isdigit():
        if int(word) >= len(elements):
            yf.reject(field, f"there is no element [{word}]", f"[0] to [{len(elements) - 1}]")
        return elements[int(word)]
    names = []
    for element in elements:
        found = yf.entries(element) if isinstance(element.node, yaml.MappingNode) else {}
        names.append(found["name"].node.value if "name" in found else "")
        if names[-1] == word:
            return element
    known = [name for name in names if name]
    return yf.reject(field, f"no element has the name '{word}'", ", ".join(known) or "[0], [1], ...",
                     yf.did_you_mean(word, known))


def find(field, target):
    """The value that a target names; throws Error where the file does not hold it."""
    for step in target.steps:
        if step.startswith("["):
            field = _element(field, step[1:-1])
            continue
        found = yf.entries(field)
        if step not in found:
            yf.reject(field, f"there is no key '{step}'", ", ".join(found) or "no key",
                      yf.did_you_mean(step, list(found))
                      or "write it into the file with its usual value, so that it can be varied")
        field = found[step]
    return field


def files_of(field):
    """The files that a scene or sensor file names, as (field, path): those that are there."""
    folder = Path(field.file).parent
    stack, found = [field], []
    while stack:
        here = stack.pop()
        if isinstance(here.node, yaml.MappingNode):
            for key, value in yf.entries(here).items():
                scalar = isinstance(value.node, yaml.ScalarNode)
                if scalar and key in FILE_KEYS and (folder / value.node.value).is_file():
                    found.append((value, folder / value.node.value))
                stack.append(value)
        elif isinstance(here.node, yaml.SequenceNode):
            stack += yf.items(here, 0)
    return sorted(found, key=lambda pair: pair[0].node.start_mark.index)


def _quoted(path):
    return "'" + str(path).replace("'", "''") + "'"


def replaced(text, field, values):
    """The text with values replaced: pairs (Target, text); paths of files become absolute, so that
    it can be read from any folder."""
    edits = [(value, _quoted(path.resolve())) for value, path in files_of(field)]
    edits += [(find(field, target), value) for target, value in values]
    edits.sort(key=lambda edit: edit[0].node.start_mark.index, reverse=True)
    for old, new in edits:
        first, last = old.node.start_mark.index, old.node.end_mark.index
        if text[first] in "&!":
            yf.reject(old, "an anchor or a tag", "a plain value", "write it out")
        text = text[:first] + new + text[last:]
    return text


def number_text(value):
    """The shortest digits that read back the same."""
    return repr(float(value)) if float(value) != int(value) else str(int(value))
