# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Campaigns run and resume after a kill; their data does not depend on how they ran."""

import json
import os
import resource
import signal
import subprocess
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from campaign_support import Campaign
from waiting import MAX_WAIT_S, wait_until

import glidar
from glidar.campaign import plan, spec, trials


def receipts(campaign, output):
    return len(list((campaign.folder / output / "receipts").glob("*.json")))


def test_every_trial_is_identical_to_a_single_measurement(campaign):
    campaign.run("out")
    table = pq.read_table(campaign.folder / "out" / "index.parquet").to_pydict()
    assert table["trial"] == list(range(40)) and all(table["ok"])
    drawn = trials.draw_trials(plan.make_plan(spec.read_spec(campaign.folder / "campaign.yaml")), 0, 40)
    scene = glidar.load_scene(campaign.folder / "scene.yaml")
    sensor = glidar.load_sensor(campaign.folder / "camera.yaml")
    shards = sorted((campaign.folder / "out" / "npz").iterdir())
    assert len(shards) == 10
    for name in shards:
        shard = np.load(name)
        for row, trial in enumerate(shard["trial"]):
            frame = glidar.simulate(scene, sensor, drawn.world_from_sensor[trial],
                                    seed=int(drawn.seed[trial]))
            cloud = frame.cloud(["range", "intensity", "status"])
            assert np.array_equal(shard["status"][row], cloud["status"])
            assert np.array_equal(shard["intensity"][row], cloud["intensity"])
            assert np.array_equal(shard["range"][row], cloud["range"].astype(np.float32),
                                  equal_nan=True)
            assert table["hits"][trial] == frame.hits and table["seed"][trial] == drawn.seed[trial]
    assert sum(table["hits"]) > 1000


def test_bags_are_those_of_single_measurements(campaign):
    campaign.add("outputs: {mcap: {every: 10}}\n")
    campaign.run("out")
    drawn = trials.draw_trials(plan.make_plan(spec.read_spec(campaign.folder / "campaign.yaml")), 0, 40)
    scene = glidar.load_scene(campaign.folder / "scene.yaml")
    sensor = glidar.load_sensor(campaign.folder / "camera.yaml")
    bags = sorted((campaign.folder / "out" / "mcap").iterdir())
    assert [path.name for path in bags] == [f"{trial:09}.mcap" for trial in (0, 10, 20, 30)]
    for path in bags:
        trial = int(path.stem)
        alone = campaign.folder / "alone.mcap"
        glidar.simulate(scene, sensor, drawn.world_from_sensor[trial], seed=int(drawn.seed[trial])).save(alone)
        assert alone.read_bytes() == path.read_bytes()


def test_data_does_not_depend_on_the_number_of_workers(campaign):
    campaign.run("one", "--workers", "1")
    campaign.run("three", "--workers", "3")
    contents = campaign.contents("one")
    assert contents == campaign.contents("three")
    for name, digest in contents.items():
        if name.startswith("npz/"):
            assert f"-{digest[:16]}.npz" in name


@pytest.mark.parametrize("workers", ["1", "2"])
def test_a_killed_run_resumes_without_loss_or_duplicates(campaign, workers):
    campaign.write("campaign.yaml", (campaign.folder / "campaign.yaml").read_text()
                   .replace("trials: 40", "trials: 200"))
    campaign.run("whole")
    kills = 0
    for wanted in (1, 3, 6, 8):
        process = campaign.start("run", "campaign.yaml", "-o", "out", "--workers", workers,
                                 start_new_session=True)
        wait_until(lambda: process.poll() is not None or receipts(campaign, "out") >= wanted, f"{wanted} receipts",
                   pause_s=0.002)
        kills += process.poll() is None
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    assert kills > 0
    before = {path: path.stat().st_mtime_ns
              for path in (campaign.folder / "out" / "receipts").iterdir()}
    campaign.run("out", "--workers", workers)
    assert campaign.contents("out") == campaign.contents("whole")
    assert all(path.stat().st_mtime_ns == when for path, when in before.items())  # not measured again
    assert not (campaign.folder / "out" / "tmp").exists()


def test_a_dead_worker_is_replaced(campaign):
    campaign.write("campaign.yaml", (campaign.folder / "campaign.yaml").read_text()
                   .replace("trials: 40", "trials: 1600"))
    campaign.run("whole")
    process = campaign.start("run", "campaign.yaml", "-o", "out", "--workers", "2")
    wait_until(lambda: receipts(campaign, "out") >= 3, "three receipts", process, pause_s=0.002)
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    workers = [int(child) for child in children
               if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes()]
    os.kill(workers[0], signal.SIGKILL)
    assert process.wait(timeout=MAX_WAIT_S) == 0, process.stderr.read()
    assert campaign.contents("out") == campaign.contents("whole")


def test_an_interrupted_run_exits_with_130_and_resumes(campaign):
    campaign.run("whole")
    process = campaign.start("run", "campaign.yaml", "-o", "out")
    wait_until(lambda: receipts(campaign, "out") >= 1, "a receipt", process, pause_s=0.002)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=MAX_WAIT_S)
    assert process.returncode in (130, 0) and "Traceback" not in err, out + err
    campaign.run("out")
    assert campaign.contents("out") == campaign.contents("whole")


def test_a_corrupt_shard_is_measured_again_and_check_reports_differences(campaign):
    campaign.run("whole")
    campaign.run("out")
    victim = sorted((campaign.folder / "out" / "npz").iterdir())[3]
    data = bytearray(victim.read_bytes())
    data[1000] ^= 1
    victim.write_bytes(data)
    assert victim.name in campaign.call("check", "out", code=1)
    victim.write_bytes(data[:-1])
    campaign.run("out")
    assert campaign.contents("out") == campaign.contents("whole")
    assert "files match the manifest" in campaign.call("check", "out")


def test_trials_with_an_invalid_scene_fail_alone(campaign):
    campaign.write("broken.yaml", "models:\n  - {model: none.obj}\n")
    campaign.write("campaign.yaml", (campaign.folder / "campaign.yaml").read_text().replace(
        "scene: scene.yaml", "scene: {grid: [scene.yaml, broken.yaml, missing.yaml, scene.yaml]}"))
    printed = campaign.run("out", code=1)
    assert "40 trials, 20 failed" in printed and "warning" in printed
    table = pq.read_table(campaign.folder / "out" / "index.parquet").to_pydict()
    assert [i % 4 in (0, 3) for i in range(40)] == table["ok"]
    assert "none.obj" in table["error"][1] and "missing.yaml" in table["error"][2]
    assert str(campaign.folder) not in "".join(table["error"]) and len(set(table["error"])) == 3
    manifest = json.loads((campaign.folder / "out" / "manifest.json").read_text())
    assert (manifest["trials"], manifest["failed"]) == (40, 20)
    shard = np.load(next((campaign.folder / "out" / "npz").glob("shard-000000-*")))
    assert shard["trial"].tolist() == [0, 3] and len(shard["range"]) == 2


def test_values_of_scene_and_sensor_and_poses_of_models_can_vary(campaign):
    campaign.add("""vary:
  sensor.noise[1].probability: {grid: [0, 1]}
  sensor.optics.fov_deg: {uniform: [30, 60]}
  scene.models[moon].scale: {choice: [0.1, 0.2]}
  scene.models[rock].pose:
    position: {point: [0, 0, 0]}
    orientation: uniform
outputs: {npz: {columns: [range, status, object_pose]}}
""")
    campaign.run("out")
    table = pq.read_table(campaign.folder / "out" / "index.parquet").to_pydict()
    assert table["sensor.noise[1].probability"] == [0.0, 1.0] * 20
    assert set(table["scene.models[moon].scale"]) == {0.1, 0.2}
    hits = np.array(table["hits"])
    assert (hits[0::2] > 0).all() and (hits[1::2] == 0).all()  # all returns are dropped
    shard = np.load(sorted((campaign.folder / "out" / "npz").iterdir())[0])
    pose = shard["24x32/object_pose"][0][shard["24x32/status"][0] == 0]
    q = np.array([table[f"scene.models[rock].pose.{name}"][0] for name in ("qw", "qx", "qy", "qz")])
    assert (np.abs(pose[:, 3:] - q).max(axis=1) < 1e-6).any()


def test_sensors_of_different_shapes_have_separate_arrays(campaign):
    campaign.write("campaign.yaml", (campaign.folder / "campaign.yaml").read_text().replace(
        "sensor: camera.yaml", "sensor: {grid: [camera.yaml, VLP-16]}"))
    campaign.run("out")
    shard = np.load(sorted((campaign.folder / "out" / "npz").iterdir())[0])
    assert shard["24x32/trial"].tolist() == [0, 2]
    shapes = {key.split("/")[0] for key in shard.files}
    assert len(shapes) == 2
    table = pq.read_table(campaign.folder / "out" / "index.parquet").to_pydict()
    assert min(table["hits"]) > 0  # the LiDAR's boresight is x, which also points at the scene


def test_merged_parts_are_byte_identical_to_a_single_run(campaign):
    campaign.add("outputs: {npz: true, tum: true, kitti: true, bop: {images: [depth]}}\n")
    campaign.run("whole")
    for i in (2, 0, 1):
        campaign.run(f"part{i}", "--shard", f"{i}/3")
    assert "missing" in campaign.call("merge", "part0", "part1", "-o", "merged", code=2)
    campaign.call("merge", "part0", "part1", "part2", "-o", "merged")
    assert campaign.contents("merged") == campaign.contents("whole")
    for i in range(3):
        campaign.run("shared", "--shard", f"{i}/3")
    campaign.call("merge", "shared")
    assert campaign.contents("shared") == campaign.contents("whole")


def test_parts_of_other_campaigns_and_corrupt_parts_are_rejected(campaign):
    campaign.run("part0", "--shard", "0/2")
    campaign.run("part1", "--shard", "1/2")
    victim = sorted((campaign.folder / "part1" / "npz").iterdir())[0]
    victim.write_bytes(victim.read_bytes()[:-1] + b"x")
    assert "differs from its receipt" in campaign.call("merge", "part0", "part1", "-o", "m", code=2)
    campaign.write("campaign.yaml", (campaign.folder / "campaign.yaml").read_text()
                   .replace("seed: 5", "seed: 6"))
    printed = campaign.run("part0", code=2)
    assert "another campaign" in printed and "campaign.seed was 5, is 6" in printed
    campaign.run("other", "--shard", "1/2")
    assert "another campaign" in campaign.call("merge", "part0", "other", "-o", "m2", code=2)


def test_a_changed_scene_is_another_campaign_and_a_comment_is_not(campaign):
    campaign.run("out")
    campaign.add("# a comment\n")
    campaign.run("out")
    campaign.write("scene.yaml", (campaign.folder / "scene.yaml").read_text().replace("0.3", "0.4"))
    assert "another campaign" in campaign.run("out", code=2)


def test_a_full_disk_is_reported_and_the_campaign_can_resume(campaign):
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (8000, 8000))

    printed = campaign.run("out", code=2, preexec_fn=limit)
    assert "cannot be written" in printed and "ulimit -f) and run the same command again to resume" in printed
    assert "Traceback" not in printed
    campaign.run("out")
    campaign.run("whole")
    assert campaign.contents("out") == campaign.contents("whole")


@pytest.mark.skipif(os.geteuid() != 0, reason="only root may mount a small disk; run it as root")
def test_a_full_file_system_is_reported(campaign):
    disk = campaign.folder / "disk"
    disk.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=128k", "tmpfs", disk],
                             capture_output=True, check=False)
    if mounted.returncode != 0:
        pytest.skip("mount is not allowed here; run it outside of a container")
    try:
        printed = campaign.run("disk/out", code=2)
        assert "No space left on device" in printed and "make room" in printed
        subprocess.run(["mount", "-o", "remount,size=16m", disk], check=True)
        campaign.run("disk/out")
        campaign.run("whole")
        assert campaign.contents("disk/out") == campaign.contents("whole")
    finally:
        subprocess.run(["umount", disk], check=True)


def peak_mib(campaign, trials):
    """The peak memory of a run with `trials` small trials."""
    campaign.write("camera.yaml", "optics: {type: pinhole, width: 8, height: 8, fov_deg: 40}\n")
    campaign.write("campaign.yaml", (campaign.folder / "campaign.yaml").read_text()
                   .replace("trials: 40", f"trials: {trials}").replace("shard_trials: 4\n", ""))
    process = campaign.start("run", "campaign.yaml", "-o", f"out{trials}", "--quiet")
    process.stdout.read()
    _, status, used = os.wait4(process.pid, 0)
    assert status == 0, process.stderr.read()
    return used.ru_maxrss / 1024


def test_memory_does_not_grow_with_the_number_of_trials(campaign, tmp_path_factory):
    few = peak_mib(campaign, 4000)
    many = peak_mib(Campaign(tmp_path_factory.mktemp("many")), 40000)
    assert many < 1.1 * few


@pytest.mark.parametrize("arguments, words", [
    (["run", "campaign.yaml"], "-o"), (["run", "none.yaml", "-o", "x"], "cannot be read"),
    (["run", "campaign.yaml", "-o", "x", "--shard", "2/2"], "i from 0 to N - 1"),
    (["run", "campaign.yaml", "-o", "x", "--workers", "0"], "a whole number from 1"),
    (["run", "campaign.yaml", "-o", "x", "--tasks", "2"], "--executor slurm"),
    (["run", "campaign.yaml", "-o", "x", "--scheduler", "a"], "--executor dask"),
    (["run", "campaign.yaml", "-o", "x", "--executor", "dask"], "add --scheduler"),
    (["run", "campaign.yaml", "-o", "."], "contains no campaign"), (["merge", "."], "contains no campaign"),
    (["report", "."], "contains no campaign"), (["walk"], "invalid choice"), ([], "COMMAND")])
def test_invalid_commands_are_rejected_with_one_line(campaign, arguments, words):
    printed = campaign.call(*arguments, code=2)
    assert printed.startswith("glidar: error: ") and words in printed and printed.count("\n") == 1


def test_varied_values_must_exist_in_the_file(campaign):
    campaign.add("vary: {sensor.limits.far_m: {uniform: [1, 2]}}\n")
    printed = campaign.run("out", code=2)
    assert "camera.yaml:1:1" in printed and "no key 'limits'" in printed


def test_a_campaign_without_a_valid_scene_or_sensor_is_rejected(campaign):
    campaign.write("scene.yaml", "models: [\n")
    assert "none can be read" in campaign.run("out", code=2)
