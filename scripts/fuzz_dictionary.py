#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Prints the dictionary of a fuzzer for libFuzzer; nothing if it has none.

usage: fuzz_dictionary.py NAME

It is tests/fuzz/dictionaries/NAME.dict, with the keys and words of the schema if the fuzzer's files have one.
"""

import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SAME = {"grey_png": "png"}
SCHEMAS = {"sensor": "sensors/sensor.schema.json", "imu": "sensors/imu.schema.json", "scene": "examples/scene.schema.json",
           "sidecar": "sensors/sensor.schema.json"}


def words_of(schema):
    """The names of all properties, and the texts that values may have."""
    if isinstance(schema, list):
        return set().union(*map(words_of, schema))
    if not isinstance(schema, dict):
        return set()
    words = set(schema.get("properties", ())) | {word for word in schema.get("enum", ()) if isinstance(word, str)}
    if isinstance(schema.get("const"), str):
        words.add(schema["const"])
    return words.union(*map(words_of, schema.values()))


def dictionary(name):
    """The lines of the dictionary."""
    lines = []
    file = ROOT / f"tests/fuzz/dictionaries/{SAME.get(name, name)}.dict"
    if file.is_file():
        lines += file.read_text(encoding="utf-8").splitlines()
    if name in SCHEMAS:
        schema = json.loads((ROOT / SCHEMAS[name]).read_text(encoding="utf-8"))
        lines += [line for word in sorted(words_of(schema)) if (line := json.dumps(word)) not in lines]
    return lines


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.stdout.write("".join(line + "\n" for line in dictionary(sys.argv[1])))


if __name__ == "__main__":
    main()
