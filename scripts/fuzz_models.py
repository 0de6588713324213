#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Feeds corrupt models to the import: `glidar info` must read or reject each within the time limit.

usage: fuzz_models.py [--seconds S] [--seed N] [--keep FOLDER] GLIDAR FOLDER...
Damages files of the folders, one after the other: changed, cut, repeated and inserted bytes, in texts also
numbers. What breaks the rule is kept in FOLDER, by default build/log, and ends the script with status 1. That the
helper process dies of a file is allowed: it is there for that, in a sandbox; it is counted.
"""

import argparse
import collections
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SUFFIXES = {".3ds", ".3mf", ".ac", ".ase", ".amf", ".b3d", ".blend", ".bvh", ".cob", ".csm", ".dae", ".dxf", ".fbx",
            ".glb", ".gltf", ".hmp", ".ifc", ".irrmesh", ".lwo", ".lws", ".md2", ".md3", ".md5mesh", ".mdl", ".ms3d",
            ".nff", ".obj", ".off", ".ogex", ".pk3", ".ply", ".q3o", ".smd", ".stl", ".ter", ".x", ".xgl", ".zgl"}
LARGEST_SEED_BYTES = 200_000
TIME_LIMIT_S = 120.0  # the helper's own is 20 s for files of this size
NUMBERS = [b"0", b"-1", b"1e39", b"nan", b"-0", b"4294967296", b"99999999999999999999", b"1e-320"]


def seeds(folders):
    found = [path for folder in folders for path in sorted(Path(folder).rglob("*"))
             if path.suffix.lower() in SUFFIXES and path.is_file() and 0 < path.stat().st_size <= LARGEST_SEED_BYTES]
    if not found:
        sys.exit(f"fuzz_models: no model of at most {LARGEST_SEED_BYTES} bytes in {' '.join(map(str, folders))}")
    return found


def damaged(data, draw):
    """The bytes with one to eight errors."""
    data = bytearray(data)
    for _ in range(draw.randint(1, 8)):
        at = draw.randrange(len(data) + 1)
        length = min(draw.choice([1, 2, 4, 8, 64, 1024]), len(data) - at)
        kind = draw.randrange(6)
        if kind == 0 and length:
            data[at] ^= 1 << draw.randrange(8)
        elif kind == 1 and length:
            data[at:at + length] = draw.randbytes(length)
        elif kind == 2:
            del data[at:at + length]
        elif kind == 3:
            data[at:at] = data[at:at + length] * draw.choice([1, 2, 16])
        elif kind == 4:
            data[at:at + 1] = draw.choice(NUMBERS)
        elif length >= 4:
            data[at:at + 4] = draw.choice([b"\xff\xff\xff\xff", b"\x00\x00\x00\x00", b"\xff\xff\xff\x7f", b"\x01\x00\x00\x80"])
        if not data:
            data = bytearray(b"0")
    return bytes(data)


def outcome(program, model, folder):
    """How `glidar info` ended: "read", "refused", "helper died", or what broke the rule."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder)}
    try:
        done = subprocess.run([program, "info", model, "--json", "--no-cache"], capture_output=True, env=environment,
                              timeout=TIME_LIMIT_S, check=False)
    except subprocess.TimeoutExpired:
        return f"it did not end within {TIME_LIMIT_S:.0f} s"
    if done.returncode == 0:
        return "read"
    if done.returncode != 2 or not done.stderr.startswith(b"glidar: error: "):
        return f"it ended with {done.returncode}: {done.stderr[-300:].decode(errors='replace')}"
    return "helper died" if b"the import process crashed" in done.stderr else "refused"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, default=Path("build/log"))
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("folders", nargs="+")
    options = parser.parse_args()
    models, draw = seeds(options.folders), random.Random(options.seed)
    end, counts = time.monotonic() + options.seconds, collections.Counter()
    with tempfile.TemporaryDirectory() as scratch:
        while time.monotonic() < end:
            original = draw.choice(models)
            model = Path(scratch) / f"model{original.suffix}"
            model.write_bytes(damaged(original.read_bytes(), draw))
            found = outcome(options.program, model, scratch)
            counts[found if found in ("read", "refused", "helper died") else "broken"] += 1
            if counts["broken"]:
                options.keep.mkdir(parents=True, exist_ok=True)
                kept = options.keep / f"broken{original.suffix}"
                shutil.copy(model, kept)
                sys.exit(f"fuzz_models: {kept}, damaged {original}: {found}")
    summary = ", ".join(f"{counts[name]} {name}" for name in ("read", "refused", "helper died"))
    print(f"models: {sum(counts.values())} files from {len(models)} models in {options.seconds:.0f} s: {summary}; no error found")


if __name__ == "__main__":
    main()
