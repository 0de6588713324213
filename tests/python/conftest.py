# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What tests of the Python package share. Run by ctest with PYTHONPATH and PATH set; alone:
PYTHONPATH=build/dev/python PATH=build/dev/apps/glidar:$PATH build/venv/bin/python -m pytest tests/python"""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import glidar

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from waiting import MAX_WAIT_S  # noqa: E402


@pytest.fixture(scope="session")
def asteroid():
    return glidar.Scene("builtin:asteroid")


@pytest.fixture(scope="session")
def camera():
    return glidar.camera(64, 48, fov_deg=30.0)


@pytest.fixture(scope="session")
def noisy():
    return glidar.camera(64, 48, fov_deg=30.0, noise=[{"type": "range_gaussian", "sigma_m": 0.01}, {"type": "dropout", "probability": 0.1}])


@pytest.fixture
def program():
    """Runs the command line; gives what it prints, or its error."""

    def run(*arguments, folder=ROOT, code=0):
        done = subprocess.run(
            ["glidar", *map(str, arguments)], cwd=folder, capture_output=True, text=True, timeout=MAX_WAIT_S, check=False
        )
        assert done.returncode == code, done.stderr
        return done.stdout if code == 0 else done.stderr

    return run


def poses_around(count, distance=6.0):
    """Sensors on a circle about the origin."""
    angles = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    return np.stack([glidar.look_at([distance * np.cos(a), distance * np.sin(a), 1.0], [0, 0, 0]) for a in angles])


def same(one, other):
    """Whether two frames are the same to the bit."""
    names = ("range_m", "intensity", "status", "sigma_m")
    return all(getattr(one, n).tobytes() == getattr(other, n).tobytes() for n in names)
