# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A campaign on Dask workers, one of which is killed, has the same bytes as that of a single process."""

import json
import os
import signal
import subprocess
import sys

import pytest
from waiting import MAX_WAIT_S, wait_until

pytest.importorskip("distributed")


def start(folder, *arguments):
    log = open(folder / f"{'-'.join(arguments[:2]).replace('/', '_')}.log", "w", encoding="utf-8")
    with log:
        return subprocess.Popen([sys.executable, "-m", "dask", *arguments], cwd=folder,
                                env=dict(os.environ, XDG_CACHE_HOME=str(folder / ".cache")),
                                stdout=log, stderr=log, start_new_session=True)


@pytest.fixture
def cluster(tmp_path):
    """A scheduler, its address, and two worker processes."""
    file = tmp_path / "scheduler.json"
    processes = [start(tmp_path, "scheduler", "--port", "0", "--no-dashboard", "--host", "127.0.0.1",
                       "--scheduler-file", str(file))]
    try:
        wait_until(lambda: file.is_file() and file.stat().st_size > 0, "the scheduler's address", processes[0])
        address = json.loads(file.read_text())["address"]
        for name in ("a", "b"):
            processes.append(start(tmp_path, "worker", address, "--nthreads", "1", "--name", name,
                                   "--no-nanny", "--no-dashboard"))
        yield address, processes
    finally:
        for process in processes:
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            process.wait()


def test_a_killed_worker_does_not_change_the_data(campaign, cluster):
    address, processes = cluster
    campaign.write("campaign.yaml", (campaign.folder / "campaign.yaml").read_text()
                   .replace("trials: 40", "trials: 2000"))
    campaign.run("whole")
    run = campaign.start("run", "campaign.yaml", "-o", "out", "--executor", "dask", "--scheduler",
                         address)
    done = campaign.folder / "out" / "receipts"
    wait_until(lambda: done.is_dir() and len(list(done.iterdir())) >= 20 or run.poll() is not None, "20 receipts",
               pause_s=0.01)
    assert run.poll() is None, run.stderr.read()
    os.killpg(processes[1].pid, signal.SIGKILL)
    out, err = run.communicate(timeout=MAX_WAIT_S)
    assert run.returncode == 0, out + err
    assert campaign.contents("out") == campaign.contents("whole")


IMPATIENT = """import sys
from glidar.campaign import cli, dask_executor
dask_executor.CONNECT_S = 0.1
sys.exit(cli.main())
"""


def test_a_missing_scheduler_is_reported(campaign):
    done = subprocess.run([sys.executable, "-c", IMPATIENT, "run", "campaign.yaml", "-o", "out", "--executor", "dask",
                           "--scheduler", "tcp://127.0.0.1:9"], cwd=campaign.folder, env=campaign.environment,
                          capture_output=True, text=True, timeout=MAX_WAIT_S, check=False)
    assert done.returncode == 2 and "no Dask scheduler answers at tcp://127.0.0.1:9" in done.stderr, done.stderr
