# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Fixtures for tests of the Python package. Run by ctest with PYTHONPATH and PATH set; alone:
PYTHONPATH=build/dev/python PATH=build/dev/apps/glidar:$PATH build/venv/bin/python -m pytest tests/python"""

import pickle
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


@pytest.fixture(scope="session")
def built():
    """A scene with a model, meshes defined in code, a copy, changed attributes and materials."""
    scene = glidar.Scene(ROOT / "models/satellite/satellite.obj")
    corners = np.array([[0.1, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) + 1e7  # far from the origin
    faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    colours = np.linspace(0, 1, 12).reshape(4, 3)
    first = scene.add_mesh(corners, faces, colours=colours, name="first", pose=glidar.pose([-1e7, -1e7, -1e7]))
    first.set_materials({"*": {"diffuse": [0.1, 0.7, 0.3]}})
    scene.add_instance(first, name="second", class_name="part", scale=0.7)
    with pytest.raises(glidar.Error):
        scene.add_model("builtin:box", name="second")  # removed, because the name is not unique
    scene.add_model("builtin:sphere", pose=glidar.pose([3, 0, 0]), class_name="ball")
    for k in range(50):
        scene["second"].pose = glidar.pose([0.1 * k - 1e7, -1e7, -1e7])
    scene["second"].class_name = "other"
    return scene


@pytest.fixture
def program():
    """Runs the command line; returns its output, or its error message."""

    def run(*arguments, folder=ROOT, code=0):
        done = subprocess.run(
            ["glidar", *map(str, arguments)], cwd=folder, capture_output=True, text=True, timeout=MAX_WAIT_S, check=False
        )
        assert done.returncode == code, done.stderr
        return done.stdout if code == 0 else done.stderr

    return run


def poses_around(count, distance=6.0):
    """Poses of sensors on a circle around the origin."""
    angles = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    return np.stack([glidar.look_at([distance * np.cos(a), distance * np.sin(a), 1.0], [0, 0, 0]) for a in angles])


def two_spheres():
    """A scene of two spheres, their poses in three frames, and the sensor's."""
    scene = glidar.Scene()
    scene.add_model("builtin:sphere", name="a")
    scene.add_instance(scene["a"], name="b")
    left, right = glidar.pose([-1, 0, 0]), glidar.pose([1, 0, 0])
    objects = np.stack([[left, right], [right, left], [left, left]])
    return scene, objects, np.repeat(glidar.look_at([0, -8, 0], [0, 0, 0])[None], 3, 0)


def same(one, other):
    """Whether two frames are bit-identical."""
    names = ("range_m", "intensity", "status", "sigma_m")
    return all(getattr(one, n).tobytes() == getattr(other, n).tobytes() for n in names)


def again(value, protocol=pickle.HIGHEST_PROTOCOL):
    """A value after pickling and unpickling."""
    return pickle.loads(pickle.dumps(value, protocol))


#: A trajectory of every type.
TRAJECTORIES = {
    "constant": lambda: glidar.Trajectory.constant(glidar.look_at([1, 2, 3], [0, 0.1, 0])),
    "spin": lambda: glidar.Trajectory.spin(glidar.look_at([1, 2, 3], [0, 0.1, 0]), [0.1, 0.2, 0.3], t0_s=0.1),
    "twist": lambda: glidar.Trajectory.twist(np.eye(4), [0.1, 0, 0.3], [1, 2, 3], in_world=True, t0_s=-3),
    "timed": lambda: glidar.Trajectory.timed(
        np.arange(200) / 7, np.stack([glidar.look_at([5, 0.1 * k, 1], [0, 0, 0.01 * k]) for k in range(200)])
    ),
    "tumbling": lambda: glidar.Trajectory.tumbling(
        glidar.look_at([1, 2, 3], [0, 0.1, 0]),
        [1, 2.5, 3],
        [0.1, 1.0, 0.01],
        body_from_principal=glidar.pose([0.1, 0, 0]),
        velocity_m_s=[1, 0, 0.1],
    ),
}
