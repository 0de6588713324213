# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Files and folders that a durable campaign syncs to the disk, in every process that writes."""

import argparse
import errno
import os
import stat

import pytest
from faults import NO_LIBRARY, Faults, library

from glidar import Error
from glidar.campaign import dask_executor, durable, folder, plan, run, slurm_executor, spec


@pytest.fixture
def synced(monkeypatch):
    """The paths that this process syncs."""
    paths, sync = [], os.fsync

    def note(descriptor):
        paths.append(os.readlink(f"/proc/self/fd/{descriptor}"))
        sync(descriptor)

    monkeypatch.setattr(os, "fsync", note)
    return paths


def measure(campaign, output, **more):
    return run.run(campaign.folder / "campaign.yaml", campaign.folder / output, workers=1, quiet=True, **more)


def failing_sync(monkeypatch, is_failing, code):
    def sync(descriptor):
        if is_failing(os.fstat(descriptor).st_mode):
            raise OSError(code, os.strerror(code))

    monkeypatch.setattr(os, "fsync", sync)


def test_runs_sync_by_default_and_not_with_no_durable(campaign, synced):
    measure(campaign, "plain", durable=False)
    assert synced == []
    measure(campaign, "out")
    names = {os.path.basename(path).split("-", 1)[-1] for path in synced if "/out/tmp/" in path}
    assert {"campaign.json", "part.parquet", "000009.json", "index.parquet", "manifest.json"} <= names
    assert campaign.contents("out") == campaign.contents("plain")


def test_names_of_new_folders_are_synced(campaign, synced):
    measure(campaign, "a/b/out")
    root = str(campaign.folder)
    for name in ("", "/a", "/a/b", "/a/b/out", "/a/b/out/npz", "/a/b/out/parts", "/a/b/out/receipts"):
        assert root + name in synced


def test_a_merge_syncs_files_that_exist_already(campaign, synced):
    for i in (0, 1):
        measure(campaign, f"p{i}", part=run.ShardSubset(i, 2), durable=False)
    first = sorted((campaign.folder / "p0" / "npz").iterdir())[0]
    (campaign.folder / "p1" / "npz" / first.name).write_bytes(first.read_bytes())  # as after a killed merge
    assert synced == []
    run.merge([campaign.folder / "p1", campaign.folder / "p0"], campaign.folder / "p1")
    assert str(campaign.folder / "p1" / "npz" / first.name) in synced


def test_file_systems_that_cannot_sync_folders_are_accepted(campaign, monkeypatch):
    for code in (errno.EINVAL, errno.ENOTSUP):
        failing_sync(monkeypatch, stat.S_ISDIR, code)
        assert measure(campaign, f"out{code}").whole


@pytest.mark.parametrize("is_failing", [stat.S_ISREG, stat.S_ISDIR])
@pytest.mark.parametrize("code, words", [(errno.EIO, "check the disk"), (errno.ENOSPC, "make room"),
                                         (errno.EDQUOT, "make room")])
def test_every_error_of_a_sync_is_reported(campaign, monkeypatch, is_failing, code, words):
    failing_sync(monkeypatch, is_failing, code)
    with pytest.raises(Error, match=f"it cannot be synced to the disk: {os.strerror(code)}.*{words}"):
        measure(campaign, "out")
    assert not (campaign.folder / "out" / "receipts").exists()


def test_a_folder_that_cannot_be_opened_is_reported(tmp_path):
    with pytest.raises(Error, match="none: it cannot be synced to the disk: No such file"):
        durable.sync_folder(tmp_path / "none")


@pytest.mark.skipif(not library(), reason=NO_LIBRARY)
def test_worker_processes_sync(campaign):
    faults = Faults(campaign.folder / "fault_injection", campaign.folder)
    campaign.environment |= faults.environment
    counts = {}
    for workers in ("1", "2"):
        faults.arm("sync")
        campaign.run(f"out{workers}", "--workers", workers, "--shard", "0/2")
        counts[workers] = faults.calls
        faults.arm("sync")
        campaign.run(f"plain{workers}", "--workers", workers, "--shard", "0/2", "--no-durable")
        assert faults.calls == 0
    assert counts["2"] >= counts["1"] >= 5 * 3  # 5 shards, each with files and a receipt


def test_dask_workers_sync(campaign, synced):
    planned = plan.make_plan(spec.read_spec(campaign.folder / "campaign.yaml"))
    for is_durable in (False, True):
        own = folder.CampaignFolder(campaign.folder / f"out{is_durable}", is_durable)
        folder.create_or_check(own, planned)
        before = len(synced)
        dask_executor.run_shards(planned, own, [0])
        assert (len(synced) > before) == is_durable


@pytest.mark.parametrize("is_durable, option", [(True, "--durable"), (False, "--no-durable")])
def test_slurm_tasks_and_merge_receive_the_durable_option(is_durable, option):
    flags = argparse.Namespace(output="out", campaign="c.yaml", sbatch=[], durable=is_durable)
    for script in slurm_executor.scripts(flags, 3):
        assert script.rstrip().endswith(f" {option}")
