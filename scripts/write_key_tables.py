#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the lists of keys in docs/ and the schemas beside the examples from the descriptions in the program.

usage: write_key_tables.py GLIDAR [ROOT]; GLIDAR is the program, ROOT the folder of the sources.
       write_key_tables.py GLIDAR --print PATH prints the table of the keys: unit, default, allowed values and meaning.
A list is between the lines `<!-- keys: PATH -->` and `<!-- end of keys -->`; `<!-- names of keys: PATH -->` has names and
defaults alone. PATH is the kind of schema and keys from there on, for example `sensor lidar_equation`; an alternative of a
type is named as `optics=pinhole`. `-KEY` at the end leaves out the keys of the map KEY, which another list has; `*` those of
all maps. Alternatives of a type have a line each, with all of their keys.
"""

import json
import re
import subprocess
import sys
import textwrap
from pathlib import Path

SCHEMA_FILES = {"sensor": "sensors/sensor.schema.json", "imu": "sensors/imu.schema.json", "scene": "examples/scene.schema.json"}
MARKED = re.compile(r"(<!-- (names of keys|keys): ([^\n]*) -->\n).*?(<!-- end of keys -->)", re.DOTALL)


def schema_text(program, kind):
    return subprocess.run([program, "schema", kind], check=True, capture_output=True, text=True).stdout


def type_of(alternative):
    """The key that selects an alternative, and what is known of its word."""
    return next((key, value) for key, value in alternative["properties"].items() if "const" in value)


def find(schema, steps):
    """The part of a schema that the steps lead to; of a sensor file, that of one sensor."""
    schema = schema.get("else", schema)
    for step in steps:
        key, _, name = step.partition("=")
        schema = schema.get("properties", {}).get(key, schema)
        schema = schema.get("items", schema)
        schema = next((form for form in schema.get("anyOf", []) if "properties" in form), schema)
        if name:
            schema = next(one for one in schema["oneOf"] if type_of(one)[1]["const"] == name)
    return schema


def shown(value):
    if isinstance(value, list):
        return "`[" + ", ".join(str(part) for part in value) + "]`"
    if isinstance(value, (bool, str)):
        return f"`{str(value).lower() if isinstance(value, bool) else value}`"
    return f"{value:.6g}"


def default_of(key, schema, required):
    if key in required:
        return "required"
    if "x-default" in schema:
        return schema["x-default"]
    return shown(schema["default"]) if "default" in schema else ""


def allowed_of(schema):
    if "x-allowed" in schema:
        return schema["x-allowed"]
    if "enum" in schema:
        return ", ".join(f"`{word}`" for word in schema["enum"])
    if "$ref" in schema:
        return "a map"
    if "anyOf" in schema:
        return " or ".join(allowed_of(form) for form in schema["anyOf"])
    if schema["type"] == "integer":
        return f"a whole number from {schema['minimum']} to {schema['maximum']}"
    if schema["type"] == "array":
        item = schema.get("items")
        is_list_of_values = isinstance(item, dict) and item.get("type") != "object"
        return "a list of " + allowed_of(item) if is_list_of_values else "a list"
    return {"object": "a map", "boolean": "`true`, `false`"}.get(str(schema["type"]), "a text")


def short_allowed(schema):
    """Without what the column of the unit and the default state: "0 to 1" for "a number from 0 to 1"."""
    text = re.sub(r"\ba (?:finite )?(map|path|text|list|number|whole number)\b", r"\1", allowed_of(schema))
    number = re.fullmatch(r"(whole number|[\w/]+) (from|above) (.+)", text)
    if not number:
        return text
    limits = number[3] if number[2] == "from" and " to " in number[3] else f"{number[2]} {number[3]}"
    return limits + (", whole" if number[1] == "whole number" else "")


def rows_of(schema, prefix=""):
    """Key, unit, default, allowed values, meaning; nested maps follow their key."""
    for key, value in schema["properties"].items():
        if "const" in value:
            continue
        yield (f"`{prefix}{key}`", value.get("x-unit", ""), default_of(key, value, schema.get("required", [])),
               short_allowed(value), value["description"])
        items = value.get("items")
        if isinstance(items, dict) and "properties" in items:
            yield from rows_of(items, f"{prefix}{key}[].")
        elif "properties" in value:
            yield from rows_of(value, f"{prefix}{key}.")


def defaults_of(key, value, required):
    """The default in brackets, the unit where the name of the key has none, and the other words that are allowed."""
    default = default_of(key, value, required)
    unit = value.get("x-unit", "") if "_" not in key and not default[:1].isalpha() else ""
    parts = [" ".join(part for part in (default, unit) if part)]
    others = [f"`{word}`" for word in value.get("enum", []) if f"`{word}`" not in default]
    parts += ["or " + ", ".join(others)] if others else []
    text = "; ".join(part for part in parts if part)
    return f" ({text})" if text else ""


def names_of(schema, prefix=""):
    """Every key as `KEY` (default), with its meaning; nested maps follow their key."""
    for key, value in schema["properties"].items():
        if "const" in value:
            continue
        items = value.get("items")
        is_list = isinstance(items, dict) and "properties" in items
        yield f"`{prefix}{key}`" + defaults_of(key, value, schema.get("required", [])), value["description"]
        if is_list or "properties" in value:
            yield from names_of(items if is_list else value, f"{prefix}{key}[]." if is_list else f"{prefix}{key}.")


def key_list(schema):
    return [f"- {name}: {meaning}" for name, meaning in names_of(schema)]


def key_names(schema):
    return textwrap.wrap(", ".join(name for name, _ in names_of(schema)), 150, break_long_words=False, break_on_hyphens=False)


def row(cells):
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def key_table(schema):
    lines = [row(("key", "unit", "default", "allowed", "meaning")), "|---|---|---|---|---|"]
    return lines + [row(cells) for cells in rows_of(schema)]


def without_keys_inside(schema, maps):
    """The keys of a map without those of these maps inside."""
    def is_left_out(key, name, part):
        return key in maps and (name == "properties" or (name == "items" and "properties" in part))

    return {**schema, "properties": {key: {name: part for name, part in value.items() if not is_left_out(key, name, part)}
                                     for key, value in schema["properties"].items()}}


def short_key(key, schema, required):
    default = default_of(key, schema, required)
    return f"`{key}`" if default == "required" else f"`{key}` ({default.strip('`')})"


def type_list(schema):
    """One line for each alternative: its keys, its effect and, in brackets, its source."""
    lines = []
    for one in schema["oneOf"]:
        selector, about = type_of(one)
        keys = [short_key(name, value, one.get("required", [])) for name, value in one["properties"].items() if name != selector]
        named = " with ".join(part for part in (f"`{about['const']}`", ", ".join(keys)) if part)
        source = f" [{about['x-source']}]" if "x-source" in about else ""
        lines.append(f"- {named}: {about['description']}{source}")
    return lines


def table(schemas, path, of_keys=key_table):
    kind, *words = path.split()
    steps = [word for word in words if word[0] not in "-*"]
    schema = find(schemas(kind), steps)
    if isinstance(schema.get("additionalProperties"), dict):
        schema = find(schema["additionalProperties"], steps)
    if "oneOf" in schema:
        return type_list(schema)
    return of_keys(without_keys_inside(schema, schema["properties"] if "*" in words else {word[1:] for word in words}))


def written(text, schemas):
    """The text with the lists as they are now."""
    def replaced(match):
        of_keys = key_list if match[2] == "keys" else key_names
        return match[1] + "\n".join(table(schemas, match[3], of_keys)) + "\n" + match[4]
    return MARKED.sub(replaced, text)


def main():
    program = sys.argv[1]
    root = Path(sys.argv[2] if len(sys.argv) > 2 else ".")
    texts = {}

    def schemas(kind):
        if kind not in texts:
            texts[kind] = schema_text(program, kind)
        return json.loads(texts[kind])

    if root == Path("--print"):
        print("\n".join(table(schemas, " ".join(sys.argv[3:]))))
        return
    for page in sorted(root.glob("docs/**/*.md")):
        old = page.read_text(encoding="utf-8")
        new = written(old, schemas)
        if new != old:
            page.write_text(new, encoding="utf-8")
            print("wrote", page)
    for kind, name in SCHEMA_FILES.items():
        schema_file = root / name
        new = schema_text(program, kind)
        if not schema_file.exists() or schema_file.read_text(encoding="utf-8") != new:
            schema_file.write_text(new, encoding="utf-8")
            print("wrote", schema_file)


if __name__ == "__main__":
    main()
