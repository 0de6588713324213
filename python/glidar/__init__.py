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
from ._cloud import Cloud
from ._errors import Error
from ._frame import Frame
from ._information import Direction, Information
from ._mesh import Mesh, from_open3d, from_trimesh
from ._object import Object
from ._pictures import Picture
from ._poses import look_at, pose, quaternion
from ._scene import Mount, Scene, load_scene, surface_names
from ._sensor import Sensor, SheetEntry, camera, load_sensor, sensor, sensor_file, sensor_names, sensor_sheet
from ._simulator import Simulator, simulate, simulate_batch, simulate_iter, simulate_rig
from ._status import Cause, Status
from ._story import Drawn, Echo, Reading, Step, Story
from ._trajectory import Trajectory
from ._truth import Truth
from ._verification import Verification, VerifyRow, verify

__version__: str = _core.version()

__all__ = [
    "Cause",
    "Cloud",
    "Direction",
    "Drawn",
    "Echo",
    "Error",
    "Frame",
    "Information",
    "Mesh",
    "Mount",
    "Object",
    "Picture",
    "Reading",
    "Scene",
    "Sensor",
    "SheetEntry",
    "Simulator",
    "Status",
    "Step",
    "Story",
    "Trajectory",
    "Truth",
    "Verification",
    "VerifyRow",
    "camera",
    "from_open3d",
    "from_trimesh",
    "load_scene",
    "load_sensor",
    "look_at",
    "pose",
    "quaternion",
    "sensor",
    "sensor_file",
    "sensor_names",
    "sensor_sheet",
    "simulate",
    "simulate_batch",
    "simulate_iter",
    "simulate_rig",
    "surface_names",
    "verify",
]
