# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The program `glidar campaign`, and the example in the documentation."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from waiting import MAX_WAIT_S

from glidar.campaign import rotations

ROOT = Path(__file__).resolve().parents[3]
pytestmark = pytest.mark.skipif(not shutil.which("glidar"), reason="the program glidar is not in PATH; run it by ./dev test")


def glidar_program(folder, *arguments, path=None):
    here = str(Path(sys.executable).parent)
    environment = dict(os.environ, PATH=f"{here}:{os.environ['PATH']}" if path is None else path)
    return subprocess.run([shutil.which("glidar"), *arguments], cwd=folder, env=environment,
                          capture_output=True, text=True, timeout=MAX_WAIT_S, check=False)


def test_the_example_campaign_runs_and_its_files_agree(tmp_path):
    for folder in ("examples", "sensors"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    done = glidar_program(tmp_path, "campaign", "run", "examples/campaign.yaml", "-o", "rocks")
    assert done.returncode == 0, done.stderr
    assert "200 trials, 0 failed" in done.stdout
    done = glidar_program(tmp_path, "campaign", "report", "rocks")
    assert done.returncode == 0 and "wrote rocks/report.html" in done.stdout
    index = pq.read_table(tmp_path / "rocks" / "index.parquet").to_pydict()
    trajectory = np.loadtxt(tmp_path / "rocks" / "trajectory.tum")
    assert np.array_equal(trajectory[:, 0], index["trial"])
    assert np.array_equal(trajectory[:, 1:4], np.stack([index[k] for k in ("x_m", "y_m", "z_m")], 1))
    assert np.array_equal(trajectory[:, 4:], np.stack([index[k] for k in ("qx", "qy", "qz", "qw")], 1))
    distance = np.linalg.norm(trajectory[:, 1:4] - [0, 0, 0.2], axis=1)
    assert 12 <= distance.min() and distance.max() <= 20
    forward = rotations.matrices(trajectory[:, [7, 4, 5, 6]])[:, :, 2]
    aim = ((np.array([0, 0, 0.2]) - trajectory[:, 1:4]) * forward).sum(axis=1) / distance
    assert np.degrees(np.arccos(aim.min())) <= 3.001
    assert min(index["hits"]) > 50


def test_help_works_without_python(tmp_path):
    done = glidar_program(tmp_path, "campaign", "--help", path="/nonexistent")
    assert done.returncode == 0 and "merge DIR" in done.stdout
    assert max(len(line) for line in done.stdout.split("\n")) <= 100


def test_help_of_commands_comes_from_the_package(tmp_path):
    done = glidar_program(tmp_path, "campaign", "run", "--help")
    assert done.returncode == 0 and "--executor" in done.stdout


def test_a_missing_glidar_package_is_reported_with_a_remedy(tmp_path):
    for name in ("python3",):
        (tmp_path / name).write_text(f"#!/bin/sh\nexec {sys.executable} -S -E \"$@\"\n")
        (tmp_path / name).chmod(0o755)
    for path in (str(tmp_path), "/nonexistent"):
        done = glidar_program(tmp_path, "campaign", "run", "c.yaml", "-o", "x", path=path)
        assert done.returncode == 2
        assert done.stderr.startswith("glidar: error: program glidar-campaign"), done.stderr
        assert "pip install" in done.stderr and done.stderr.count("\n") == 1


def test_a_missing_command_is_rejected(tmp_path):
    done = glidar_program(tmp_path, "campaign")
    assert done.returncode == 2 and "run, merge, report, check" in done.stderr


def test_missing_dependencies_are_reported_with_a_remedy(tmp_path):
    code = ("import sys; sys.modules['PIL'] = None; from glidar.campaign.cli import main; "
            "sys.exit(main(['report', 'x']))")
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True,
                          check=False)
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert "'PIL' is missing" in done.stderr and "pip install" in done.stderr


def test_nothing_in_the_current_folder_is_executed(tmp_path):
    """Neither programs in empty and relative folders of PATH nor modules in those of PYTHONPATH are used."""
    attack = "open('ATTACKED', 'w').write('x')\n"
    package = tmp_path / "glidar" / "campaign"
    package.mkdir(parents=True)
    for path in (package.parent / "__init__.py", package / "__init__.py", package / "__main__.py"):
        path.write_text("import pathlib; pathlib.Path('ATTACKED').write_text('x')\n")
    for name in ("usercustomize.py", "sitecustomize.py", "runpy.py", "yaml.py", "numpy.py", "argparse.py"):
        (tmp_path / name).write_text(attack)
    (tmp_path / "bin").mkdir()
    for name in ("glidar-campaign", "python3", "bin/glidar-campaign", "bin/python3"):
        (tmp_path / name).write_text("#!/bin/sh\ntouch ATTACKED\n")
        (tmp_path / name).chmod(0o755)
    here = str(Path(sys.executable).parent)
    environment = dict(os.environ, PATH=f":.:bin:./bin::{here}:{os.environ['PATH']}:",
                       PYTHONPATH=f":.:{os.environ.get('PYTHONPATH', '')}:")
    for arguments in (["--help"], ["run", "none.yaml", "-o", "x"], ["check", "none"]):
        done = subprocess.run([shutil.which("glidar"), "campaign", *arguments], cwd=tmp_path, env=environment,
                              capture_output=True, text=True, timeout=MAX_WAIT_S, check=False)
        assert not (tmp_path / "ATTACKED").exists(), arguments
        assert "Traceback" not in done.stderr
    assert "none" in done.stderr


def test_relative_folders_in_path_are_ignored(tmp_path):
    (tmp_path / "glidar-campaign").write_text("#!/bin/sh\ntouch ATTACKED\n")
    (tmp_path / "glidar-campaign").chmod(0o755)
    for path in (".", "", ":", "bin:.."):
        done = glidar_program(tmp_path, "campaign", "check", "x", path=path)
        assert done.returncode == 2 and "neither beside glidar nor in PATH" in done.stderr
        assert not (tmp_path / "ATTACKED").exists()
