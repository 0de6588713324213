# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A campaign folder that several runs share, and runs that end early."""

import contextlib
import itertools
import os
import re
import signal
import subprocess
import sys

import pytest
from waiting import MAX_WAIT_S, pauses, wait_until

from glidar import Error
from glidar.campaign import files, folder, plan, run, spec, work


def damage(root, kind="npz"):
    """Changes one byte of a file; returns its name."""
    victim = sorted((root / kind).iterdir())[-1]
    data = bytearray(victim.read_bytes())
    data[len(data) // 2] ^= 1
    victim.write_bytes(data)
    return victim.name


def parts(campaign):
    for i in (0, 1):
        campaign.run(f"p{i}", "--shard", f"{i}/2")
    return campaign.folder / "p0"


@pytest.mark.parametrize("kind", ["npz", "parts"])
def test_merging_into_a_part_checks_its_files(campaign, kind):
    name = damage(parts(campaign), kind)
    printed = campaign.call("merge", "p0", "p1", code=2)
    assert name in printed and "differs from its receipt" in printed and "run the part again" in printed
    assert not (campaign.folder / "p0" / "manifest.json").exists()
    assert not (campaign.folder / "p0" / "tmp").exists()


def test_merging_a_single_folder_checks_its_files(campaign):
    for i in (0, 1):
        campaign.run("out", "--shard", f"{i}/2")
    name = damage(campaign.folder / "out")
    assert name in campaign.call("merge", "out", code=2)


def test_merging_replaces_a_file_of_the_same_length_that_differs(campaign):
    campaign.run("whole")
    root = parts(campaign)
    name = damage(root)
    receipt = next(path for path in (root / "receipts").iterdir() if name in path.read_text())
    receipt.unlink()  # so that the file looks like one of an interrupted run
    campaign.run("again", "--shard", "0/2")
    campaign.call("merge", "p0", "again", "p1")
    assert campaign.contents("p0") == campaign.contents("whole")


def test_a_finished_run_keeps_temporary_files_of_another_run(campaign):
    root = campaign.folder / "out"
    mine = files.TempFolder(root)
    path = mine.path("half.npz")
    path.write_text("half")
    campaign.run("out")
    assert path.read_text() == "half"
    mine.remove()
    assert not (root / "tmp").exists()


INTERFERE = """import contextlib, os, sys
removed, wanted = 0, int(sys.argv[2])
while removed < wanted:
    with contextlib.suppress(OSError):
        if sys.argv[3] == "make":
            os.mkdir(sys.argv[1])
        os.rmdir(sys.argv[1])
        removed += 1
"""


def repeat_beside(action, tmp, removals, *, makes):
    """Repeats an action while another process removes `tmp` so many times when it is empty; with `makes`, it makes it
    before."""
    def is_done():
        action()
        return other.poll() is not None

    with subprocess.Popen([sys.executable, "-c", INTERFERE, tmp, str(removals), "make" if makes else "keep"]) as other:
        try:
            wait_until(is_done, "the other process", pause_s=0.0)
        finally:
            other.kill()
    assert other.returncode == 0 and not tmp.exists()


def test_temporary_folders_are_made_although_another_process_removes_the_folder_above_them(campaign):
    def write():
        with files.temp_folder(campaign.folder) as temp:
            temp.path("half.npz").write_text("half")

    repeat_beside(write, campaign.folder / "tmp", 100, makes=False)


def test_stale_files_are_removed_although_another_process_removes_their_folder(campaign):
    repeat_beside(lambda: files.remove_stale_files(campaign.folder), campaign.folder / "tmp", 2000, makes=True)


def test_a_file_in_place_of_the_temporary_folder_is_reported(campaign):
    campaign.write("tmp", "in the way")
    with pytest.raises(Error, match="cannot be written"), files.temp_folder(campaign.folder) as temp:
        temp.path("half.npz")


def slow(campaign):
    campaign.write("campaign.yaml", (campaign.folder / "campaign.yaml").read_text()
                   .replace("trials: 40", "trials: 4000"))


def count_temporary(root):
    """The number of temporary files of all workers, which may remove any at any time."""
    count = 0
    with contextlib.suppress(FileNotFoundError):
        for folder in list((root / "tmp").iterdir()):
            with contextlib.suppress(FileNotFoundError, NotADirectoryError):
                count += len(os.listdir(folder))
    return count


@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM])
def test_a_stopped_run_of_many_workers_leaves_no_partial_files(campaign, end):
    slow(campaign)
    process = campaign.start("run", "campaign.yaml", "-o", "out", "--workers", "2")
    wait_until(lambda: count_temporary(campaign.folder / "out") >= 2, "files of two workers", process, pause_s=0.001)
    process.send_signal(end)
    out, err = process.communicate(timeout=MAX_WAIT_S)
    assert process.returncode == 130 and "Traceback" not in err, out + err
    assert not (campaign.folder / "out" / "tmp").exists()


def put_a_file_in_place_of(folder):
    """Repeats until it succeeds, because a worker may create the folder again between the two steps."""
    for k in itertools.count():
        folder.rename(folder.parent.parent / f"moved_{k}")
        try:
            folder.write_text("in the way")
            return
        except IsADirectoryError:
            pass


def test_a_failed_run_of_many_workers_leaves_no_partial_files(campaign):
    slow(campaign)
    process = campaign.start("run", "campaign.yaml", "-o", "out", "--workers", "2")
    wait_until((campaign.folder / "out" / "receipts").exists, "the first receipts", process, pause_s=0.001)
    put_a_file_in_place_of(campaign.folder / "out" / "npz")
    out, err = process.communicate(timeout=MAX_WAIT_S)
    assert process.returncode == 2 and re.search("cannot be (written|synced)", err), out + err
    assert not (campaign.folder / "out" / "tmp").exists()


def test_a_write_error_ends_a_worker_that_waits_for_shards(campaign):
    planned = plan.make_plan(spec.read_spec(campaign.folder / "campaign.yaml"))
    campaign.write("out", "in the way")

    def shards():
        yield 0
        yield from pauses("the error")

    with pytest.raises(Error, match="cannot be written"):
        work.work(planned, folder.CampaignFolder(campaign.folder / "out"), shards(), 1, lambda done: None)


def test_a_renamed_campaign_file_resumes_the_campaign(campaign):
    campaign.run("out", "--shard", "0/2")
    (campaign.folder / "campaign.yaml").rename(campaign.folder / "renamed.yaml")
    campaign.call("run", "renamed.yaml", "-o", "out", "--shard", "1/2")
    assert "40 trials" in campaign.call("merge", "out")
    campaign.write("renamed.yaml", (campaign.folder / "renamed.yaml").read_text().replace("seed: 5", "seed: 6"))
    assert "campaign.seed was 5, is 6" in campaign.call("run", "renamed.yaml", "-o", "out", code=2)


def test_an_invalid_bop_sensor_leaves_no_folder(campaign):
    text = (campaign.folder / "campaign.yaml").read_text() + "outputs: {bop: true}\n"
    campaign.write("campaign.yaml", text.replace("sensor: camera.yaml", "sensor: VLP-16"))
    assert "for BOP a pinhole camera" in campaign.run("out", code=2)
    assert not (campaign.folder / "out").exists()
    campaign.write("campaign.yaml", text)
    campaign.run("out")


def test_a_run_that_no_executor_started_leaves_no_folder(campaign):
    (campaign.folder / "sbatch").write_text("#!/bin/sh\necho 'no such partition' >&2\nexit 1\n")
    (campaign.folder / "sbatch").chmod(0o755)
    campaign.environment["PATH"] = f"{campaign.folder}:{os.environ['PATH']}"
    assert "no such partition" in campaign.run("out", "--executor", "slurm", code=2)
    assert not (campaign.folder / "out").exists()

    def execute(plan, folder, shards, report):
        raise Error("--scheduler", "nobody answers", "", "")

    with pytest.raises(Error, match="nobody answers"):
        run.run(campaign.folder / "campaign.yaml", campaign.folder / "out", execute=execute, quiet=True)
    assert not (campaign.folder / "out").exists()


def test_a_folder_with_measured_shards_is_kept(campaign):
    def execute(plan, folder, shards, report):
        run.run_local(plan, folder, shards[:1], report, 1)
        raise Error("--scheduler", "lost", "", "")

    with pytest.raises(Error, match="lost"):
        run.run(campaign.folder / "campaign.yaml", campaign.folder / "out", execute=execute, quiet=True)
    assert (campaign.folder / "out" / "campaign.json").exists()
    campaign.run("out")


def test_the_most_frequent_error_of_failed_trials_is_printed(campaign):
    campaign.write("broken.yaml", "models:\n  - {model: none.obj}\n")
    campaign.write("campaign.yaml", (campaign.folder / "campaign.yaml").read_text().replace(
        "scene: scene.yaml", "scene: {grid: [scene.yaml, broken.yaml, missing.yaml, broken.yaml]}"))
    for more in ([], ["--shard", "0/2"]):
        printed = campaign.run("out" + "".join(more[:1]), *more, code=1)
        assert f"trials failed, {20 // len(more or [1])} of {30 // len(more or [1])}: broken.yaml:2:" in printed
        assert "none.obj" in printed


SCRIPT = """from glidar.campaign.run import run
{guard}
    print(run("campaign.yaml", "out", workers={workers}, quiet=True).trials)
"""


def run_script(campaign, guard, workers):
    campaign.write("script.py", SCRIPT.format(guard=guard, workers=workers))
    return subprocess.run([sys.executable, "script.py"], cwd=campaign.folder, env=campaign.environment,
                          capture_output=True, text=True, timeout=MAX_WAIT_S, check=False)


def test_a_script_without_main_guard_is_reported(campaign):
    done = run_script(campaign, "if True:", 2)
    assert done.returncode == 1 and done.stdout == ""
    assert "script.py: it runs the campaign when it is imported" in done.stderr
    assert 'if __name__ == "__main__":' in done.stderr.splitlines()[-1]
    assert done.stderr.count("Traceback") == 1  # none from a worker
    assert not (campaign.folder / "out").exists()


def test_scripts_with_main_guard_or_one_worker_run(campaign):
    for guard, workers in (('if __name__ == "__main__":', 2), ("if True:", 1)):
        done = run_script(campaign, guard, workers)
        assert done.returncode == 0 and done.stdout == "40\n", done.stderr
