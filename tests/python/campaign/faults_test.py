# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Disk errors during a campaign: every error is reported, completed shards stay valid, and the same command then gives
the same bytes."""

import functools
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from campaign_support import Campaign, memory_folder
from faults import ERRORS, NO_LIBRARY, Faults, library
from waiting import MAX_WAIT_S

pytestmark = pytest.mark.skipif(not library(), reason=NO_LIBRARY)
RUNS = Path(__file__).with_name("fault_runs.py")
SCENE = """models:
  - {name: rock, model: builtin:box, scale: 1}
  - {name: moon, model: builtin:box, scale: 0.3, pose: {position: [1.2, 0, 0]}}
"""
RUN = ("run", "campaign.yaml", "-o", "out", "--workers", "1", "--quiet")
MERGE = ("merge", "p0", "p1", "-o", "out")
FAULTS = [(RUN, "open", "ENOSPC"), (RUN, "write", "EIO"), (RUN, "write", "ENOSPC"), (RUN, "sync", "EIO"),
          (RUN, "rename", "EIO"), (RUN, "close", "EIO"), (MERGE, "write", "ENOSPC"), (MERGE, "sync", "EIO"),
          (MERGE, "rename", "EIO"), (MERGE, "close", "EIO")]


@pytest.fixture(scope="module")
def made():
    """A campaign with all outputs, its parts, and the files of the complete campaign."""
    with tempfile.TemporaryDirectory(dir=memory_folder()) as folder:
        yield make_campaign(Path(folder))


def make_campaign(folder):
    campaign = Campaign(folder)
    text = (campaign.folder / "campaign.yaml").read_text()
    campaign.write("campaign.yaml", text.replace("trials: 40", "trials: 2").replace("shard_trials: 4", "shard_trials: 1")
                   + "outputs: {npz: true, pcd: true, kitti: true, tum: true, bop: {images: [depth]}}\n")
    campaign.write("scene.yaml", SCENE)
    campaign.write("camera.yaml", "optics: {type: pinhole, width: 8, height: 6, fov_deg: 40}\n")
    campaign.run("whole", "--no-durable")
    for i in (0, 1):
        campaign.run(f"p{i}", "--shard", f"{i}/2")
    return campaign


@functools.cache
def with_faults(campaign, call, error, command):
    """A record of fault_runs.py for each failing call."""
    state = campaign.folder / "fault_injection"
    shutil.rmtree(campaign.folder / "out", ignore_errors=True)
    faults = Faults(state, campaign.folder / "out")
    done = subprocess.run([sys.executable, str(RUNS), str(state), "out", call, error, *command], cwd=campaign.folder,
                          env=campaign.environment | faults.environment, capture_output=True, text=True,
                          timeout=MAX_WAIT_S, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def check(record, whole, error):
    """Checks the state after a failed run and the result of the next run."""
    reason = re.compile(f"{ERRORS[error]}|error closing file")  # the latter is Arrow's
    described = f"call {record['at']}, on {record['path']}: {record['text']}"
    if record["code"] == 0:  # logs may lack lines
        assert "/out/log/" in record["path"], described
    else:
        assert record["code"] == 2, described
        assert record["text"].startswith("glidar: error: ") and reason.search(record["text"]), described
        assert re.search(r"\bout\b", record["text"].split(": ")[2]), described
    assert record["left"].items() <= whole.items(), described  # complete files only, and none in tmp
    assert record["again"] == 0, record["again_text"]
    assert record["contents"] == whole, described


@pytest.mark.parametrize("command, call, error", FAULTS, ids=[f"{f[0][0]}-{f[1]}-{f[2]}" for f in FAULTS])
def test_every_failed_call_is_reported_and_the_next_run_gives_the_same_bytes(made, command, call, error):
    whole = made.contents("whole")
    records = with_faults(made, call, error, command)
    assert len(records) >= 20
    for record in records:
        check(record, whole, error)


def test_nothing_is_synced_with_no_durable(made):
    assert with_faults(made, "sync", "EIO", (*RUN, "--no-durable")) == []
    assert with_faults(made, "sync", "EIO", (*MERGE, "--no-durable")) == []


def test_every_file_and_folder_is_synced(made):
    """Each sync call fails once, which lists all paths that are synced."""
    root = str((made.folder / "out").resolve())
    paths = {record["path"].replace(root, "out") for record in with_faults(made, "sync", "EIO", RUN)}
    folders = {str(Path("out", name).parent) for name in made.contents("whole")}
    above = {str(path) for folder in folders for path in Path(folder).parents} - {"."}
    assert folders | above <= paths
    temp = [path for path in paths if path.startswith("out/tmp/")]
    assert {Path(path).suffix for path in temp} == {".npz", ".pcd", ".bin", ".txt", ".png", ".json", ".parquet",
                                                       ".ply", ".tum"}


def test_shards_are_synced_in_the_order_data_names_receipt(made):
    """A run that stops at any sync leaves only receipts whose files were synced before."""
    seen = []
    for record in with_faults(made, "sync", "EIO", RUN):
        receipts = {name for name in record["left"] if name.startswith("receipts/0")}
        if "/tmp/" in record["path"] and record["path"].endswith((".npz", ".pcd", ".png", ".bin", ".parquet")):
            seen.append((record["path"], receipts))
            names = {name for name in record["left"] if name.startswith("npz/")}
            assert len(names) == len(receipts), record  # no file of this shard has its final name yet
        if record["path"].endswith("/out/npz"):
            assert len([name for name in record["left"] if name.startswith("npz/")]) == len(receipts) + 1
    assert seen
