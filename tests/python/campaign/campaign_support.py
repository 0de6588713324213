# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A small campaign in a folder of its own, and the program that runs it."""

import contextlib
import hashlib
import io
import logging
import os
import signal
import subprocess
import sys
from unittest import mock

from waiting import MAX_WAIT_S

from glidar.campaign import cli

SCENE = """models:
  - {name: rock, model: builtin:box, scale: 1}
  - {name: moon, model: builtin:sphere, scale: 0.3, pose: {position: [1.2, 0, 0]}}
"""
CAMERA = """optics: {type: pinhole, width: 32, height: 24, fov_deg: 40}
noise:
  - {type: range_gaussian, sigma_m: 0.01}
  - {type: dropout, probability: 0.05}
"""
CAMPAIGN = """scene: scene.yaml
sensor: camera.yaml
seed: 5
trials: 40
shard_trials: 4
pose:
  position: {shell: {radius_m: [3, 5]}}
  orientation: {look_at: {max_offset_deg: 5, roll_deg: {uniform: [-180, 180]}}}
"""


def memory_folder():
    """A folder in memory, for tests that make and remove thousands of folders, which takes long on a disk; None: none."""
    return "/dev/shm" if os.access("/dev/shm", os.W_OK) else None


def contents_of(root):
    """Hash of every file that is the same in every run: all but the logs."""
    return {str(path.relative_to(root)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(root.rglob("*"))
            if path.is_file() and path.relative_to(root).parts[0] not in ("log", "report.html")}


@contextlib.contextmanager
def program_in(folder, environment):
    """Prepares this process for the program: its folder and environment, and what main() changes is restored."""
    on_sigterm, handlers = signal.getsignal(signal.SIGTERM), logging.getLogger("glidar").handlers
    before = list(handlers)
    try:
        with contextlib.chdir(folder), mock.patch.dict(os.environ, environment):
            yield
    finally:
        handlers[:] = before
        signal.signal(signal.SIGTERM, on_sigterm)


class Campaign:
    def __init__(self, folder):
        self.folder = folder
        self.write("scene.yaml", SCENE)
        self.write("camera.yaml", CAMERA)
        self.write("campaign.yaml", CAMPAIGN)
        self.environment = dict(os.environ, XDG_CACHE_HOME=str(folder / ".cache"))
        self._own_environment = dict(self.environment)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def add(self, text):
        self.write("campaign.yaml", (self.folder / "campaign.yaml").read_text() + text)

    def command(self, *arguments):
        return [sys.executable, "-m", "glidar.campaign", *arguments]

    def start(self, *arguments, **more):
        return subprocess.Popen(self.command(*arguments), cwd=self.folder, env=self.environment,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)

    def call(self, *arguments, code=0, apart=False, **more):
        """Runs to the end; gives standard output and error. It runs in a process of its own only with `apart` or `more`, or
        if the environment was changed, because starting one takes longer than most campaigns here."""
        if apart or more or self.environment != self._own_environment:
            process = self.start(*arguments, **more)
            text = "".join(process.communicate(timeout=MAX_WAIT_S))
            result = process.returncode
        else:
            result, text = self._main(*arguments)
        assert result == code, text
        return text

    def _main(self, *arguments):
        """The exit code and the output of the program's function."""
        out, err = io.StringIO(), io.StringIO()
        with program_in(self.folder, self.environment), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            result = cli.main(list(arguments))
        return result, out.getvalue() + err.getvalue()

    def run(self, output, *arguments, code=0, **more):
        return self.call("run", "campaign.yaml", "-o", output, *arguments, code=code, **more)

    def contents(self, output):
        return contents_of(self.folder / output)
