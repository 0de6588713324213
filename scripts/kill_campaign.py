#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Kills a small campaign (SIGKILL to its process group) at random moments and resumes it. After every kill all files
that a receipt lists must have its hashes; whenever the campaign is complete, it must have the bytes of one that was not
disturbed. Moments are calls that write, sync, rename, open or close files, since the folder changes by these alone; a kill
at a write leaves half of it.

Exit code 1 when a file differs. Needs the built program in PATH, its Python package, and the library of the tests
(tests/support/fault_injection.cpp), which is beside them."""

import argparse
import collections
import os
import shutil
import signal
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "tests/python/campaign")]
from campaign_support import CAMPAIGN, contents_of  # noqa: E402
from faults import NO_LIBRARY, Faults, library, random_below  # noqa: E402

import pyarrow.parquet  # noqa: E402,F401  # once, before the runs are forked

from glidar.campaign import folder as folders, records, run as running  # noqa: E402
from glidar.campaign.cli import main as campaign_main  # noqa: E402

SHARDS = 8
SCENE = "models: [{name: rock, model: 'builtin:box'}]\n"
SENSOR = "optics: {type: pinhole, width: 16, height: 12, fov_deg: 40}\nnoise: [{type: range_gaussian, sigma_m: 0.01}]\n"
OUTPUTS = "outputs: {npz: true, pcd: true, kitti: true, tum: true, bop: {images: [depth]}}\n"
STATE = "GLIDAR_FAULT_STATE"
EXAMPLE = """example:
  PYTHONPATH=build/dev/python PATH=$PWD/build/dev/apps/glidar:$PATH build/venv/bin/python scripts/kill_campaign.py --kills 500"""


class Campaign:
    def __init__(self, folder, more):
        self.folder, self.more = folder, more
        text = CAMPAIGN.replace("trials: 40", f"trials: {2 * SHARDS}").replace("shard_trials: 4", "shard_trials: 2")
        for name, content in (("scene.yaml", SCENE), ("camera.yaml", SENSOR), ("campaign.yaml", text + OUTPUTS)):
            (folder / name).write_text(content, encoding="utf-8")
        self.faults = Faults(os.environ[STATE], folder)

    def run(self, name, at=0):
        """Runs or resumes in a process and process group of its own, which is killed at a call; returns its exit code."""
        self.faults.arm("any", at, "kill")
        child = os.fork()
        if child == 0:
            os.setsid()
            os.dup2(os.open(self.folder / "log.txt", os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644), 1)
            os.dup2(1, 2)
            path = str(self.folder / "campaign.yaml")
            os._exit(campaign_main(["run", path, "-o", str(self.folder / name), "--quiet", *self.more]))
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        calls = self.faults.calls
        self.faults.disarm()
        return code, calls

    def findings(self, name):
        """What a killed run left: the phase, how many shards have receipts, and files that differ from them."""
        root = self.folder / name
        folder = folders.CampaignFolder(root)
        if not folder.plan_file().is_file():
            return "starting", 0, []
        described = records.read_campaign(folder.plan_file())
        receipts = [(path, records.read_receipt(path, described)) for path in records.receipts_in(root)]
        wrong = [f"{path.name}: {file}" for path, receipt in receipts
                 for file in folders.wrong_files(root, receipt["files"])]
        if (root / "manifest.json").is_file():
            wrong += [f"manifest.json: {file}" for file in running.check(root)[1]]
        done = SHARDS - folders.count_missing(folder, described)
        complete = "complete" if (root / "manifest.json").is_file() else "finishing"
        return "measuring" if done < SHARDS else complete, done, wrong


def kill(campaign, kills, seed):
    """Prints what was found; returns whether all was right."""
    _, calls = campaign.run("whole")
    whole = contents_of(campaign.folder / "whole")
    print(f"seed {seed}; undisturbed: {len(whole)} files, {calls} calls", flush=True)
    phases, errors, done, number, receipts, completed = collections.Counter(), [], 0, 0, 0, 0
    while sum(phases.values()) < kills and not errors:
        number += 1
        left = SHARDS + 1 - done if done < SHARDS else SHARDS  # else it would be killed at its end again and again
        at = 1 + random_below(seed, number, calls * left // (SHARDS + 1))
        code, _ = campaign.run("out", at)
        if code == -signal.SIGKILL:
            phase, done, errors = campaign.findings("out")
            phases[phase] += 1
            receipts += done
            continue
        completed, done = completed + 1, 0
        if code != 0 or contents_of(campaign.folder / "out") != whole:
            errors = [f"run {number}: exit code {code}, or other bytes than undisturbed; see {campaign.folder}"]
        else:
            shutil.rmtree(campaign.folder / "out")
    if not errors and campaign.run("out")[0] == 0 and contents_of(campaign.folder / "out") == whole:
        completed += 1
    elif not errors:
        errors = [f"the last run has other bytes than undisturbed; see {campaign.folder}"]
    counts = ", ".join(f"{count} {phase}" for phase, count in sorted(phases.items()))
    print(f"{sum(phases.values())} kills ({counts}); {receipts} receipts checked; {completed} campaigns completed; "
          f"{len(errors)} errors")
    print("\n".join(errors), end="\n" if errors else "")
    return not errors


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0], epilog=EXAMPLE,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=1, help="processes of the campaign [1]")
    parser.add_argument("--no-durable", action="store_true")
    flags = parser.parse_args()
    if not library():
        sys.exit(NO_LIBRARY)
    folder = Path(tempfile.mkdtemp(prefix="glidar-kills-")) if STATE not in os.environ else None
    if folder:  # once more, with the library
        state = folder / "fault_injection"
        os.environ.update(Faults(state, folder).environment)
        os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])
    folder = Path(os.environ[STATE]).parent
    more = ["--workers", str(flags.workers), "--no-durable" if flags.no_durable else "--durable"]
    is_right = kill(Campaign(folder, more), flags.kills, flags.seed)
    if is_right:
        shutil.rmtree(folder)
    return 0 if is_right else 1


if __name__ == "__main__":
    sys.exit(main())
