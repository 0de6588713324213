# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads YAML with errors that state file:line:column and the field, like glidar's own files."""

import difflib
import math
import re
from dataclasses import dataclass

import yaml

from glidar import Error
from glidar._errors import excerpt
from glidar.campaign import files

MAX_BYTES = 2 << 20
MAX_NODES = 1_000_000  # of a file with expanded aliases, plus NODES_PER_BYTE for each byte
NODES_PER_BYTE = 2
MAX_NAME_BYTES = 4096  # of a path: the limit of Linux
MAX_WORD_LENGTH = 200  # for which a similar key is suggested
NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?")


@dataclass(frozen=True)
class Field:
    """A value of a YAML file, with its location for errors."""

    file: str
    path: str  # "vary.sensor.rate_hz"; empty for the whole file
    node: yaml.Node


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


def where(field):
    """"file:line:column: path", line and column from 1."""
    mark = field.node.start_mark
    place = f"{field.file}:{mark.line + 1}:{mark.column + 1}"
    return f"{place}: {field.path}" if field.path else place


def reject(field, found, allowed="", remedy=""):
    raise Error(where(field), found, allowed, remedy)


def did_you_mean(word, known):
    if len(word) > MAX_WORD_LENGTH:
        return ""
    near = difflib.get_close_matches(word, known, 1)
    return f"did you mean '{near[0]}'?" if near else ""


def describe(field):
    """The value of a field, for errors."""
    node = field.node
    if isinstance(node, yaml.MappingNode):
        return "a map"
    if isinstance(node, yaml.SequenceNode):
        return f"a list of {len(node.value)}"
    if node.value == "" and node.style is None:
        return "nothing"
    shown = excerpt(node.value)
    return shown if is_number(node) else f"the text '{shown}'"


def is_number(node):
    """Whether a node is a number: a plain scalar in YAML 1.2's syntax, such as 1e-3; a quoted one is a string."""
    return isinstance(node, yaml.ScalarNode) and node.style is None and bool(
        NUMBER.fullmatch(node.value))


def syntax_error(path, error):
    mark = getattr(error, "problem_mark", None)
    place = f"{path}:{mark.line + 1}:{mark.column + 1}" if mark else str(path)
    return Error(place, excerpt(getattr(error, "problem", None) or error),
                 "YAML with one map", "")


def read_text(path):
    """The text of a YAML file; raises Error when it cannot be read."""
    data = files.read_bytes(path, MAX_BYTES)
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        raise Error(str(path), "it is not text in UTF-8", "a YAML file", "") from None


class Loader(yaml.SafeLoader):
    """Gives scalars of aliases the location of the alias, not of the anchor."""

    def compose_node(self, parent, index):
        alias = self.peek_event()
        node = super().compose_node(parent, index)
        if isinstance(alias, yaml.AliasEvent) and isinstance(node, yaml.ScalarNode):
            return yaml.ScalarNode(node.tag, node.value, alias.start_mark, alias.end_mark, node.style)
        return node


def parse(text, path):
    """The map of a YAML text, as a Field."""
    try:
        documents = list(yaml.compose_all(text, Loader=Loader))
    except RecursionError:
        raise Error(str(path), "nested too deeply", "YAML with at most some hundred levels", "") from None
    except (yaml.YAMLError, ValueError, OverflowError) as error:  # ValueError: an invalid escaped character
        raise syntax_error(path, error) from None
    if len(documents) != 1 or not isinstance(documents[0], yaml.MappingNode):
        raise Error(str(path), "it is empty, not a map, or several documents", "YAML with one map", "")
    field = Field(str(path), "", documents[0])
    _require_few_nodes(field, MAX_NODES + NODES_PER_BYTE * len(text))
    return field


def _children(node):
    if isinstance(node, yaml.MappingNode):
        return [part for pair in node.value for part in pair]
    return node.value if isinstance(node, yaml.SequenceNode) else []


def _require_text(file, node):
    """Rejects strings with surrogates or zero bytes, which escapes may contain and which end a name for the system."""
    if "\0" in node.value or any("\ud800" <= letter <= "\udfff" for letter in node.value):
        reject(Field(file, "", node), "a string with a zero byte or an unpaired surrogate", "text in UTF-8")


def _require_few_nodes(field, max_nodes):
    """Raises Error when expanded aliases make a small file large or infinite."""
    sizes = {}  # by identity; 0: of a node that contains this one
    stack = [field.node]
    while stack:
        node = stack[-1]
        if sizes.get(id(node)):
            stack.pop()
        elif isinstance(node, yaml.ScalarNode):
            _require_text(field.file, node)
            sizes[id(node)] = 1
        elif id(node) not in sizes:
            sizes[id(node)] = 0
            inner = [child for child in _children(node) if not sizes.get(id(child))]
            if any(id(child) in sizes for child in inner):
                reject(Field(field.file, "", node), "an alias of a value that contains it", "aliases of other values")
            stack += inner
        else:
            sizes[id(node)] = 1 + sum(sizes[id(child)] for child in _children(node))
            if sizes[id(node)] > max_nodes:
                reject(Field(field.file, "", node), f"more than {max_nodes} values with its aliases expanded",
                       f"{MAX_NODES} values, and {NODES_PER_BYTE} more for each byte of the file",
                       "use fewer aliases, or smaller ones")


def read_yaml(path):
    return parse(read_text(path), path)


def child(field, key, node):
    name = excerpt(key)
    return Field(field.file, f"{field.path}.{name}" if field.path else name, node)


def entries(field):
    """All entries of a map, in the order of the file; rejects duplicate keys."""
    if not isinstance(field.node, yaml.MappingNode):
        reject(field, describe(field), "a map")
    found = {}
    for key, value in field.node.value:
        name = key.value if isinstance(key, yaml.ScalarNode) else "?"
        if not isinstance(key, yaml.ScalarNode) or name in found:
            problem = "given twice" if name in found else "a key that is not a string"
            reject(Field(field.file, f"{field.path}.{name}".strip("."), key), problem, "each key once")
        found[name] = child(field, name, value)
    return found


def require_keys(field, known):
    """The entries of a map; rejects unknown keys."""
    found = entries(field)
    for name, value in found.items():
        if name not in known:
            key = next(k for k, v in field.node.value if k.value == name)
            reject(Field(field.file, value.path, key), f"unknown key '{excerpt(name)}'", ", ".join(known),
                   did_you_mean(name, known))
    return found


def need(field, found, key):
    if key not in found:
        reject(field, f"the key '{key}' is missing", "a map with it")
    return found[key]


def items(field, min_count=1, max_count=1 << 20):
    """All elements of a list."""
    if not isinstance(field.node, yaml.SequenceNode):
        reject(field, describe(field), "a list")
    if not min_count <= len(field.node.value) <= max_count:
        reject(field, describe(field), f"a list of {min_count} to {max_count}" if min_count < max_count
               else f"a list of {min_count}")
    return [Field(field.file, f"{field.path}[{i}]", node) for i, node in enumerate(field.node.value)]


def number(field, rule=ANY):
    if not is_number(field.node):
        reject(field, describe(field), rule.allowed)
    value = float(field.node.value)
    inside = rule.min < value < rule.max if rule.without_ends else rule.min <= value <= rule.max
    if not (math.isfinite(value) and inside):
        reject(field, describe(field), rule.allowed)
    return value


def whole(field, low, high):
    text = field.node.value if is_number(field.node) else ""
    digits = re.fullmatch(r"\+?0*(\d{1,20})", text)  # more are too large, and too many for int()
    if not digits or not low <= int(digits[1]) <= high:
        reject(field, describe(field), f"a whole number from {low} to {high}")
    return int(digits[1])


def boolean(field):
    node = field.node
    if not isinstance(node, yaml.ScalarNode) or node.value not in ("true", "false") or node.style:
        reject(field, describe(field), "true or false")
    return node.value == "true"


def text(field):
    node = field.node
    if not isinstance(node, yaml.ScalarNode) or node.value == "":
        reject(field, describe(field), "a text")
    return node.value


def name(field):
    """The path of a file, or a name that is looked up."""
    found = text(field)
    if len(found.encode()) > MAX_NAME_BYTES:
        reject(field, describe(field), f"a text of at most {MAX_NAME_BYTES} bytes")
    return found


def one_of(field, words):
    word = text(field)
    if word not in words:
        reject(field, f"'{excerpt(word)}'", ", ".join(words), did_you_mean(word, words))
    return word


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
