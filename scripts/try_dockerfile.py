#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the steps of the Dockerfile without Docker: each image is a bare Debian in a folder (bare_debian.sh).

usage: try_dockerfile.py [FOLDER]; FOLDER (default: build/docker) gets one system per image. Needs root.
Then it renders with the last image as an arbitrary user in a mounted folder, as docs/install.md shows.
"""

import fnmatch
import glob
import json
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BARE = ROOT / "scripts/bare_debian.sh"
SUITES = {"debian:12": "bookworm", "debian:12-slim": "bookworm"}
ANY_USER = "12345"


@dataclass
class Image:
    """A stage of the Dockerfile: its system and what later instructions set."""

    root: Path
    workdir: str = "/"
    user: str = "root"
    env: dict = field(default_factory=dict)
    entrypoint: list = field(default_factory=list)
    cmd: list = field(default_factory=list)

    def run(self, *command, user=None):
        settings = [f"{name}={value}" for name, value in self.env.items()]
        user = user or self.user
        become = [] if user == "root" else ["setpriv", f"--reuid={user}", "--regid=0", "--clear-groups"]
        subprocess.run([BARE, "run", self.root, *become, "env", "-C", self.workdir, *settings, *command], check=True)


def instructions():
    """The Dockerfile's instructions in order: (name, rest of the line)."""
    text = (ROOT / "Dockerfile").read_text(encoding="utf-8").replace("\\\n", " ")
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    return [tuple(line.split(maxsplit=1)) for line in lines]


def ignored(path):
    """True for a path that .dockerignore, whose patterns here are without exceptions, keeps out."""
    rules = (ROOT / ".dockerignore").read_text(encoding="utf-8").split("\n")
    rules = [rule.removeprefix("**/") for rule in rules if rule and not rule.startswith("#")]
    places = [path.as_posix(), *(parent.as_posix() for parent in path.parents), *path.parts[1:]]
    return any(fnmatch.fnmatch(place, rule) for place in places for rule in rules)


def copy_context(target):
    """COPY . TARGET: what is tracked by git or could be, and is not ignored by Docker."""
    listed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard", "-z"], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout
    for name in filter(None, listed.split("\0")):
        if not ignored(Path(name)):
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, target / name)


def copy(images, image, rest):
    *options, source, target = rest.split()
    inside = image.root / target.lstrip("/")
    if not options:
        copy_context(inside)
        return
    origin = images[options[0].removeprefix("--from=")].root
    found = glob.glob(str(origin / source.lstrip("/")))
    if not found:
        raise SystemExit(f"COPY {rest}: {source} matches nothing")
    for file in found:
        shutil.copy2(file, inside)


def apply(images, image, name, rest):
    """One instruction on the image that is being built."""
    print(f"{name} {rest}", flush=True)
    if name == "COPY":
        copy(images, image, rest)
    elif name == "RUN":
        image.run("/bin/sh", "-c", rest)
    elif name == "WORKDIR":
        image.workdir = rest
        (image.root / rest.lstrip("/")).mkdir(parents=True, exist_ok=True)
    elif name == "USER":
        image.user = rest
    elif name == "ENV":
        image.env.update([rest.split("=", 1)])
    elif name in ("ENTRYPOINT", "CMD"):
        setattr(image, name.lower(), json.loads(rest))
    else:
        raise SystemExit(f"{name} is not known here")


def build(folder):
    """All stages; gives the last image."""
    images = {}
    image = None
    for name, rest in instructions():
        if name == "FROM":
            words = rest.split()
            key = words[2] if len(words) == 3 else "last"
            image = images[key] = Image(folder / key)
            print(f"FROM {rest}", flush=True)
            subprocess.run([BARE, "make", SUITES[words[0]], image.root], check=True)
        else:
            apply(images, image, name, rest)
    return image


def main():
    if os.geteuid() != 0:
        raise SystemExit("try_dockerfile: must be run as root, because it makes systems in folders")
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/docker").resolve()
    folder.mkdir(parents=True, exist_ok=True)
    image = build(folder)
    image.run(*image.entrypoint, *image.cmd)
    data = image.root / image.workdir.lstrip("/")
    os.chown(data, int(ANY_USER), 0)  # as a folder of the user's that is mounted there
    model = "/usr/share/glidar/models/satellite/satellite.obj"
    image.run(*image.entrypoint, "render", model, "-o", "cloud.pcd", "-o", "cloud.png", user=ANY_USER)
    for output in ("cloud.pcd", "cloud.png"):
        written = (data / output).stat()
        if written.st_size == 0 or written.st_uid != int(ANY_USER):
            raise SystemExit(f"{output} is empty or not the user's")
    print("the Dockerfile's steps work")


if __name__ == "__main__":
    main()
