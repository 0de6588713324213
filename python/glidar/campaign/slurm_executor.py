# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a campaign as a Slurm job array: task i of N measures part i, a last job merges."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from glidar import Error
from glidar._errors import excerpt
from glidar._printing import print_line
from glidar.campaign import files, run as running

TASKS = 8
# -P: no module is imported from the job's working folder
PROGRAM = f"{shlex.quote(sys.executable)} -P -m glidar.campaign"

ARRAY = """#!/bin/sh
#SBATCH --job-name={name}
#SBATCH --array=0-{last}
#SBATCH --output={log}/slurm-%A-%a.txt
{options}
exec {program} run {campaign} -o {root} --shard "$SLURM_ARRAY_TASK_ID/{count}" \\
  --workers "${{SLURM_CPUS_PER_TASK:-1}}" --quiet {durable}
"""

MERGE = """#!/bin/sh
#SBATCH --job-name={name}-merge
#SBATCH --output={log}/slurm-%j-merge.txt
{options}
exec {program} merge {root} {durable}
"""


def scripts(flags, count):
    """The texts of the two batch scripts."""
    root = Path(flags.output).resolve()
    name = re.sub(r"[^A-Za-z0-9_.-]", "_", Path(flags.campaign).stem)
    words = {"name": name, "last": count - 1, "count": count, "log": root / "log",
             "options": "\n".join(f"#SBATCH {option}" for option in flags.sbatch) or "#",
             "durable": "--durable" if flags.durable else "--no-durable", "program": PROGRAM, "root": shlex.quote(str(root)),
             "campaign": shlex.quote(str(Path(flags.campaign).resolve()))}
    return ARRAY.format(**words), MERGE.format(**words)


def _find_program(name):
    """A program in an absolute folder of PATH; None if there is none. Relative folders are unsafe."""
    for folder in os.environ.get("PATH", os.defpath).split(os.pathsep):
        path = os.path.join(folder, name)
        if os.path.isabs(folder) and os.path.isfile(path) and os.access(path, os.X_OK):
            return path
    return None


def _sbatch(script, *options):
    """Submits a script; returns the job's id."""
    done = subprocess.run([_find_program("sbatch"), "--parsable", *options, str(script)], capture_output=True,
                          text=True, check=False)
    if done.returncode != 0 and "--wait" not in options:
        raise Error("sbatch", excerpt(done.stderr.strip()) or f"exit code {done.returncode}", "", "")
    return done.stdout.strip().split(";")[0]


def _write_scripts(folder, texts):
    places = [folder.place(f"log/{name}.sbatch") for name in ("array", "merge")]
    for place, text in zip(places, texts):
        try:
            place.write(text)
        except OSError as error:
            raise files.write_error(place, error) from None
    return [place.path for place in places]


def _submit_array(paths):
    """Submits the job array; returns its id. Removes the scripts when that fails."""
    try:
        return _sbatch(paths[0])
    except Error:
        for path in paths:
            path.unlink(missing_ok=True)
        raise


def submit(flags):
    """Writes and submits the scripts. Waits for the end when requested, and then returns the Outcome."""
    if not _find_program("sbatch"):
        raise Error("--executor slurm", "the program sbatch is missing", "a machine that submits to Slurm",
                    "install slurm-client, or run the parts by hand: --shard i/N")
    if flags.shard != (0, 1):
        raise Error("--shard", "given with --executor slurm, whose tasks are the parts", "", "")
    with running.opened_for_run(flags.campaign, flags.output, durable=flags.durable) as (plan, folder):
        count = min(flags.tasks or TASKS, plan.shards)
        paths = _write_scripts(folder, scripts(flags, count))
        array = _submit_array(paths)
    print_line(f"submitted job {array}: {count} tasks")
    wait = ["--wait"] if flags.wait else []
    merge = _sbatch(paths[1], f"--dependency=afterany:{array}", *wait)
    print_line(f"submitted job {merge}: merge, after all tasks")
    return running.merge([flags.output], flags.output, flags.durable) if flags.wait else None
