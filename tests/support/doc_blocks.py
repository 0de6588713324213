# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the marked blocks of a page in the order of the page, in one folder.

A comment above a fenced block specifies its use; NAME is the test that runs the page:
  <!-- run by NAME -->                a block `sh` or `python` that succeeds without warnings
  <!-- run by NAME, exit code 2 -->   the same, but it ends with this code; 0: it succeeds, with warnings
  <!-- written by NAME: FILE -->      the block is written to FILE
A block `text` below a block that runs is its output, abridged: every number in it must be in the real output.
"""

import contextlib
import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

from waiting import MAX_WAIT_S

ROOT = Path(__file__).resolve().parents[2]
MARK = r"<!-- (run|written) by {name}(?:, exit code (\d+)|: (\S+))? -->\n```(\w+)\n(.*?)```(?:\n\n```text\n(.*?)```)?"
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?!\w)")


def marked_blocks(page, name):
    """(verb, exit code, file, language, text, shown output or "") of each marked block."""
    text = (ROOT / page).read_text(encoding="utf-8")
    found = re.findall(MARK.format(name=re.escape(name)), text, re.DOTALL)
    if len(found) != text.count(f" by {name}"):
        raise AssertionError(f"{page}: a mark of {name} is not followed by a block")
    return found


def link_inputs(folder):
    """What the commands of the documentation name, as in a clone; and python3, the one that runs the test."""
    for shown in ("models", "examples", "sensors"):
        (Path(folder) / shown).symlink_to(ROOT / shown)
    python = Path(folder) / ".bin" / "python3"  # a virtual environment's Python is not found through a link
    python.parent.mkdir()
    python.write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} "$@"\n', encoding="utf-8")
    python.chmod(0o755)


def run_page(page, name, folder, replace=()):
    """Runs the marked blocks of a page in `folder`; raises AssertionError where one does not do what the page shows.
    `replace` is pairs of texts, such as a port and a free one."""
    blocks = marked_blocks(page, name)
    assert blocks, f"{page} has no blocks that {name} runs"
    for verb, code, file, language, text, shown in blocks:
        for old, new in replace:
            text, shown = text.replace(old, new), shown.replace(old, new)
        if verb == "written":
            path = Path(folder) / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
            continue
        output = run_block(language, text, folder, code)
        missing = set(NUMBER.findall(shown)) - set(NUMBER.findall(output))
        assert not missing, f"{page}: the page shows numbers that are not printed: {sorted(missing)}\n{text}\n{output}"


def run_block(language, text, folder, code=""):
    """What a block prints, on both streams. `code` is the exit code that the page shows, if any."""
    start = {"sh": ["bash", "-euo", "pipefail", "-c"], "python": [sys.executable, "-c"]}[language]
    path = f"{Path(folder).resolve() / '.bin'}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path, "XDG_CACHE_HOME": str(folder), "MPLBACKEND": "Agg"}
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:  # files: pipes would wait for orphans
        program = subprocess.Popen([*start, text], cwd=folder, env=environment, stdout=out, stderr=err, start_new_session=True)
        try:
            program.wait(MAX_WAIT_S)
        finally:
            with contextlib.suppress(ProcessLookupError):  # programs in the background that a failed block leaves
                os.killpg(program.pid, signal.SIGKILL)
            program.wait()
        out.seek(0)
        err.seek(0)
        printed, messages = out.read(), err.read()
    assert program.returncode == int(code or 0), f"exit code {program.returncode}\n{text}\n{printed}\n{messages}"
    if not code:
        assert "warning" not in messages, f"{text}\n{messages}"
    return printed + messages
