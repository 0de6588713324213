# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""GLIDAR simulates 3D sensors: what a depth camera or LiDAR would measure of a 3D model, with the
exact truth beside every number.

    import glidar

    scene = glidar.Scene("builtin:asteroid")
    frame = glidar.simulate(scene, glidar.camera(512, 512, fov_deg=40.0))
    frame.save("asteroid.pcd")
"""

from . import _core
from ._errors import Error
from .frame import Cause, Cloud, Frame, Status, Truth
from .poses import look_at, pose, quaternion
from .scene import Object, Scene, load_scene
from .sensor import Sensor, camera, load_sensor, sensor_file, sensor_names
from .simulator import Simulator, simulate, simulate_batch
from .trajectory import Trajectory

__version__: str = _core.version()

__all__ = [
    "Cause",
    "Cloud",
    "Error",
    "Frame",
    "Object",
    "Scene",
    "Sensor",
    "Simulator",
    "Status",
    "Trajectory",
    "Truth",
    "camera",
    "load_scene",
    "load_sensor",
    "look_at",
    "pose",
    "quaternion",
    "sensor_file",
    "sensor_names",
    "simulate",
    "simulate_batch",
]
