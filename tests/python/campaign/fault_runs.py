# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs `glidar campaign` repeatedly in one process, with a different failing call in each run; faults_test.py starts
it with the library of tests/support/faults.py. Prints a line of JSON for every run.

usage: fault_runs.py FAULT_STATE OUTPUT CALL ERROR COMMAND...
"""

import contextlib
import io
import json
import shutil
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from faults import Faults  # noqa: E402

from campaign_support import contents_of  # noqa: E402
from glidar.campaign import durable  # noqa: E402
from glidar.campaign.cli import main  # noqa: E402


def run(arguments):
    """The exit code and the output."""
    text = io.StringIO()
    with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
        code = main(arguments)
    return code, text.getvalue()


def runs(faults, output, call, error, arguments):
    """One run for each call, until a run has fewer calls."""
    at = 0
    while True:
        at += 1
        shutil.rmtree(output, ignore_errors=True)
        faults.arm(call, at, error)
        code, text = run(arguments)
        hits, path = faults.hits, faults.path
        faults.disarm()
        if not hits:
            return
        left = contents_of(output)
        again, again_text = run(arguments)
        yield {"at": at, "path": path, "code": code, "text": text, "left": left, "again": again, "again_text": again_text,
               "contents": contents_of(output)}


def start():
    state, output, call, error, *arguments = sys.argv[1:]
    output = Path(output)
    faults = Faults(state, output)
    faults.disarm()
    durable.THREADS = 1  # calls have the same order in every run
    for record in runs(faults, output, call, error, arguments):
        print(json.dumps(record), flush=True)


if __name__ == "__main__":
    start()
