# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The package's type annotations pass mypy --strict."""

import subprocess
import sys
from pathlib import Path

import pytest

import glidar

PROGRAM = '''
import numpy as np
import glidar

scene = glidar.Scene()
box = scene.add_model("builtin:box", pose=np.eye(4), name="box")
box.pose = glidar.pose([0, 0, 1], xyzw=[0, 0, 0, 1])
sensor: glidar.Sensor = glidar.camera(64, 48, noise=[{"type": "range_gaussian", "sigma_m": 0.01}])
frame: glidar.Frame = glidar.simulate(scene, sensor, glidar.look_at([4, 0, 2], [0, 0, 0]), seed=3)
nearest: float = float(np.nanmin(frame.range_m))
frames: list[glidar.Frame] = glidar.simulate_batch(scene, sensor, np.stack([np.eye(4)] * 3), [1, 2, 3])
spin = glidar.Trajectory.spin(np.eye(4), [0, 0, 1])
frames.append(glidar.simulate(scene, "VLP-16", spin, objects=[np.eye(4)]))
xyz = frame.cloud(["xyz"], frame="world", drop_invalid=True)["xyz"]
print(xyz.shape, frame.fisher_information().bound, frame.explain(0).steps, nearest)
try:
    glidar.load_sensor("none")
except glidar.Error as error:
    print(error.where, error.remedy)
'''


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    """What mypy remembers of packages, once for all programs and each set of options."""
    return tmp_path_factory.mktemp("mypy")


def check(cache, path, *arguments):
    pytest.importorskip("mypy")
    package = str(Path(glidar.__file__).parent.parent)
    return subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", *arguments, str(path)],
        env={"MYPYPATH": package, "PATH": "/usr/bin:/bin", "MYPY_CACHE_DIR": str(cache / "_".join(arguments))},
        capture_output=True,
        text=True,
        check=False,
    )


def test_mypy_accepts_a_typed_program(cache, tmp_path):
    path = tmp_path / "program.py"
    path.write_text(PROGRAM)
    done = check(cache, path)
    assert done.returncode == 0, done.stdout + done.stderr
    exec(compile(PROGRAM, "program", "exec"), {})


CAMPAIGN = '''
from pathlib import Path

from glidar.campaign.run import Outcome, ShardSubset, check, merge, run

if __name__ == "__main__":
    outcome: Outcome = run("campaign.yaml", Path("part0"), ShardSubset(0, 2), workers=2, quiet=True)
    print(outcome.trials, outcome.failed, outcome.error.upper())
    count, wrong = check("part0") if merge(["part0", "part1"], "out").whole else (0, [])
    print(count + 1, [name.upper() for name in wrong])
'''


def test_mypy_accepts_a_program_that_runs_campaigns(cache, tmp_path):
    path = tmp_path / "program.py"
    path.write_text(CAMPAIGN)
    done = check(cache, path, "--follow-imports=silent")
    assert done.returncode == 0, done.stdout + done.stderr
    path.write_text(CAMPAIGN.replace('ShardSubset(0, 2)', '"0/2"').replace("outcome.error", "outcome.errors"))
    done = check(cache, path, "--follow-imports=silent")
    assert done.stdout.count("error:") == 2, done.stdout


def test_mypy_rejects_a_program_with_type_errors(cache, tmp_path):
    path = tmp_path / "program.py"
    path.write_text("import glidar\n\nglidar.camera(width='wide')\nglidar.Scene().nothing\n")
    done = check(cache, path)
    assert done.stdout.count("error:") == 2, done.stdout
