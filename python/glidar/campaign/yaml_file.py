# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads YAML by the reader of scene and sensor files, with errors that state file:line:column and the field.

A field is a _core.YamlValue, whose methods raise these errors.
"""

import difflib
import re
from dataclasses import dataclass

from glidar import Error, _core
from glidar.campaign import files

MAX_BYTES = 2 << 20
MAX_NAME_BYTES = 4096  # of a path: the limit of Linux
MAX_WORD_LENGTH = 200  # for which a similar key is suggested


@dataclass(frozen=True)
class Rule:
    """The allowed range of a number, with its description for errors."""

    min: float = -1.0e15
    max: float = 1.0e15
    without_ends: bool = False
    allowed: str = "a number from -1e15 to 1e15"


ANY = Rule()
ABOVE_ZERO = Rule(0.0, 1.0e15, True, "a number above 0")
FROM_ZERO = Rule(0.0, 1.0e15, False, "a number from 0")
ANGLE_DEG = Rule(-360.0, 360.0, False, "a number from -360 to 360")
CONE_DEG = Rule(0.0, 180.0, False, "a number from 0 to 180")


reject = _core.YamlValue.reject
entries = _core.YamlValue.entries  # of a map, in the order of the file; rejects duplicate keys
require_keys = _core.YamlValue.require_keys  # the same; rejects unknown keys
boolean = _core.YamlValue.boolean
text = _core.YamlValue.text


def did_you_mean(word, known):
    if len(word) > MAX_WORD_LENGTH:
        return ""
    near = difflib.get_close_matches(word, known, 1)
    return f"did you mean '{near[0]}'?" if near else ""


def read_text(path):
    """The text of a YAML file; raises Error when it cannot be read."""
    data = files.read_bytes(path, MAX_BYTES)
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        raise Error(str(path), "it is not text in UTF-8", "a YAML file", "") from None


def parse(content, path):
    """The map of a YAML text."""
    if "\0" in content:
        raise Error(str(path), "a zero byte", "a YAML file", "")
    return _core.YamlValue(str(path), content)


def read_yaml(path):
    return parse(read_text(path), path)


def is_map(field):
    return field.kind == "map"


def is_single(field):
    """Whether it is a single value, or none."""
    return field.kind in ("text", "none")


def need(field, found, key):
    if key not in found:
        reject(field, f"the key '{key}' is missing", "a map with it")
    return found[key]


def items(field, min_count=1, max_count=1 << 20):
    """All elements of a list."""
    found = field.items()
    if not min_count <= len(found) <= max_count:
        reject(field, field.description, f"a list of {min_count} to {max_count}" if min_count < max_count
               else f"a list of {min_count}")
    return found


def number(field, rule=ANY):
    return field.number(rule.min, rule.max, rule.without_ends, rule.allowed)


def whole(field, low, high):
    spelled = field.value if field.is_number() else ""
    digits = re.fullmatch(r"\+?0*(\d{1,20})", spelled)  # more are too large, and too many for int()
    if not digits or not low <= int(digits[1]) <= high:
        reject(field, field.description, f"a whole number from {low} to {high}")
    return int(digits[1])


def name(field):
    """The path of a file, or a name that is looked up."""
    found = text(field)
    if len(found.encode()) > MAX_NAME_BYTES:
        reject(field, field.description, f"a text of at most {MAX_NAME_BYTES} bytes")
    return found


def one_of(field, words):
    return words[field.one_of(words)]


def numbers(field, count, rule=ANY):
    return [number(item, rule) for item in items(field, count, count)]


def span(field, rule=ANY):
    """A pair [min, max] with min < max."""
    low, high = numbers(field, 2, rule)
    if not low < high:
        reject(field, f"[{low:g}, {high:g}]", "two numbers, the second above the first")
    return low, high


def direction(field):
    """A list of three numbers that are not all zero."""
    vector = numbers(field, 3)
    if not any(vector):
        reject(field, "a vector of length 0", "a direction [x, y, z]")
    return vector


def only_key(field, known):
    """The single entry of a map that selects a type."""
    found = require_keys(field, known)
    if len(found) != 1:
        reject(field, f"{len(found)} keys", f"one of {', '.join(known)}")
    return next(iter(found.items()))


def optional(found, key, read, otherwise):
    """The value of a key, read by `read`, or a default when the key is missing."""
    return read(found[key]) if key in found else otherwise
