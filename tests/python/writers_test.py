# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Several processes that write the same cloud concurrently."""

import json
import subprocess
import sys

import glidar

WRITER = """import sys
import glidar
sensor = glidar.camera(16, 12, fov_deg=40, noise=[{"type": "range_gaussian", "sigma_m": 0.1}])
frame = glidar.simulate(glidar.load_scene("builtin:sphere"), sensor, seed=int(sys.argv[1]), threads=1)
print("ready", flush=True)
for line in sys.stdin:
    frame.save("a.csv")
    print("saved", flush=True)
"""
ROUNDS = 150


def test_concurrent_writers_leave_a_matching_cloud_and_sidecar(tmp_path):
    writers = [subprocess.Popen([sys.executable, "-c", WRITER, str(seed)], cwd=tmp_path, text=True,
                                stdin=subprocess.PIPE, stdout=subprocess.PIPE) for seed in (1, 2)]
    by_seed = {}
    for seed, writer in enumerate(writers, 1):
        assert writer.stdout.readline() == "ready\n"
        writer.stdin.write("go\n")
        writer.stdin.flush()
        assert writer.stdout.readline() == "saved\n"
        by_seed[seed] = (tmp_path / "a.csv").read_bytes()
    assert by_seed[1] != by_seed[2]
    mixed = 0
    for _ in range(ROUNDS):
        for writer in writers:
            writer.stdin.write("go\n")
            writer.stdin.flush()
        for writer in writers:
            assert writer.stdout.readline() == "saved\n"
        seed = json.loads((tmp_path / "a.glidar.json").read_text())["seed"]
        mixed += (tmp_path / "a.csv").read_bytes() != by_seed[seed]
    for writer in writers:
        writer.stdin.close()
        assert writer.wait() == 0
    assert mixed == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "a.glidar.json"]


def test_sidecars_do_not_overwrite_inputs(tmp_path):
    import pytest

    sensor = tmp_path / "q.glidar.json"
    sensor.write_text("optics: {type: pinhole, width: 8, height: 6, fov_deg: 40}\n")
    frame = glidar.simulate(glidar.load_scene("builtin:sphere"), glidar.load_sensor(sensor))
    with pytest.raises(glidar.Error, match="q.glidar.json: is an input file"):
        frame.save(tmp_path / "q.pcd")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["q.glidar.json"]
    frame.save(tmp_path / "q.pcd", sidecar=False)
