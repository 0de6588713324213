# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A campaign as a job array of a real Slurm installation, with controller and node on this machine, has the same bytes
as that of a single process."""

import os
import shutil
import signal
import socket
import subprocess

import pytest
from waiting import wait_until

PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "sinfo"]
MISSING = [name for name in PROGRAMS if not shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin")]
pytestmark = [
    pytest.mark.skipif(bool(MISSING), reason=f"no {', '.join(MISSING)}; ./dev test installs them"),
    pytest.mark.skipif(os.geteuid() != 0, reason="slurmd runs jobs as root only; run it as root"),
    pytest.mark.skipif(not os.path.ismount("/sys/fs/cgroup"), reason="slurmd needs /sys/fs/cgroup; mount it"),
]

CONF = """ClusterName=campaign
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmdPort={node_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def daemon(folder, *arguments):
    with open(folder / f"{arguments[0]}.out", "w", encoding="utf-8") as log:
        return subprocess.Popen(arguments, stdout=log, stderr=log, start_new_session=True)


def is_idle():
    printed = subprocess.run(["sinfo", "-h", "-o", "%t"], capture_output=True, text=True, check=False)
    return printed.stdout.strip() == "idle"


@pytest.fixture(scope="module")
def slurm(tmp_path_factory):
    folder = tmp_path_factory.mktemp("slurm")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", os.environ["PATH"] + ":/usr/sbin")
        patch.setenv("SLURM_CONF", str(folder / "slurm.conf"))
        yield from run_slurm(folder)


def run_slurm(folder):
    """Runs the daemons until the generator is resumed."""
    host = socket.gethostname().split(".")[0]
    (folder / "slurm.conf").write_text(CONF.format(
        host=host, folder=folder, port=free_port(), node_port=free_port(), cpus=os.cpu_count()))
    for name in ("state", "spool"):
        (folder / name).mkdir()
    key = folder / "munge.key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o600)
    daemons = [daemon(folder, "munged", "--foreground", "--force", f"--key-file={key}",
                      f"--socket={folder}/munge.sock", f"--pid-file={folder}/munged.pid",
                      f"--log-file={folder}/munged.log", f"--seed-file={folder}/munge.seed")]
    try:
        wait_until((folder / "munge.sock").exists, f"the socket; see {folder}/munged.out", daemons[0])
        daemons.append(daemon(folder, "slurmctld", "-D"))
        daemons.append(daemon(folder, "slurmd", "-D"))
        wait_until(is_idle, f"an idle node; see {folder}/slurmctld.log", daemons[1], pause_s=0.2)
        yield folder
    finally:
        for process in reversed(daemons):
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(timeout=60)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def test_a_job_array_gives_the_bytes_of_a_single_process(campaign, slurm):
    campaign.environment.update(PATH=os.environ["PATH"], SLURM_CONF=os.environ["SLURM_CONF"])
    campaign.run("whole")
    printed = campaign.run("out", "--executor", "slurm", "--tasks", "3", "--sbatch=--time=10:00",
                        "--wait")
    assert "3 tasks" in printed and "40 trials, 0 failed" in printed
    assert campaign.contents("out") == campaign.contents("whole")
    script = (campaign.folder / "out" / "log" / "array.sbatch").read_text()
    assert "#SBATCH --array=0-2" in script and "#SBATCH --time=10:00" in script
    logs = (campaign.folder / "out" / "log").glob("slurm-*.txt")
    assert len(list(logs)) == 4  # three parts and the merge


def test_errors_of_sbatch_are_reported(campaign, slurm):
    campaign.environment.update(PATH=os.environ["PATH"], SLURM_CONF=os.environ["SLURM_CONF"])
    printed = campaign.run("out", "--executor", "slurm", "--sbatch=--partition=none", code=2)
    assert "glidar: error: sbatch" in printed and "invalid partition" in printed


def test_shard_cannot_be_combined_with_a_job_array(campaign, slurm):
    campaign.environment.update(PATH=os.environ["PATH"], SLURM_CONF=os.environ["SLURM_CONF"])
    printed = campaign.run("out", "--executor", "slurm", "--shard", "0/2", code=2)
    assert "--shard" in printed


def test_a_missing_sbatch_is_reported_with_a_remedy(campaign, slurm):
    campaign.environment["PATH"] = "/nonexistent"
    printed = campaign.run("out", "--executor", "slurm", code=2)
    assert "program sbatch is missing" in printed and "--shard i/N" in printed
