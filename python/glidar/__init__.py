# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""GLIDAR simulates 3D sensors: what a depth camera or LiDAR would measure of a 3D model, with the
ground truth of every beam.

    import glidar

    scene = glidar.Scene("builtin:asteroid")
    frame = glidar.simulate(scene, glidar.camera(512, 512, fov_deg=40.0))
    frame.save("asteroid.pcd")
"""

from . import _core
from ._cloud import Cloud
from ._errors import Error
from ._depth_images import RawImage
from ._frame import Frame
from ._fisher_information import EigenDirection, FisherInformation
from ._imu import Imu, ImuSamples, RigImu, imu_names, load_imu, rig_imus, simulate_imu, simulate_imus
from ._depth import AlignedDepth, DepthAligner, DepthFilters, recommended_depth_filters
from ._mesh import Mesh, from_open3d, from_trimesh
from ._object import SceneObject
from ._object_box import ObjectBox
from ._output import Output, open_output, output_formats
from ._pictures import Picture
from ._poses import look_at, pose, quaternion
from ._scene import ModelPart, Scene, list_parts, load_scene, surface_names
from ._scene_data import RigSensor
from ._presets import DatasheetEntry, SensorPreset, datasheet, sensor_file, sensor_names, sensor_presets
from ._sensor import Sensor, camera, load_sensor, sensor
from ._simulate import simulate, simulate_batch, simulate_iter, simulate_rig
from ._simulator import Simulator
from ._stereo import (StereoMatch, StereoOptions, StereoStatus, StereoTest, StereoTrace, explain_stereo, match_stereo,
                      sample_stereo_pair)
from ._tof import (TofCandidate, TofEdgeTest, TofFilter, TofFrame, TofMeasurement, TofMisfitTest, TofOptions, TofStatus, TofTest,
                   TofTrace, decode_tof, explain_tof, sample_tof_images)
from ._structured_light import DecodedFringes, FringeStatus, FringeTest, FringeTrace, StructuredLight
from ._status import ReturnSource, Status
from ._point_trace import RandomSample, Echo, Measurement, NoiseStep, PointTrace
from ._trajectory import Trajectory
from ._ground_truth import GroundTruth
from ._accuracy import AccuracyReport, AccuracyCase, verify

__version__: str = _core.version()

__all__ = [
    "ReturnSource",
    "Cloud",
    "AlignedDepth",
    "DepthAligner",
    "DepthFilters",
    "EigenDirection",
    "RandomSample",
    "Echo",
    "Error",
    "Frame",
    "RawImage",
    "FisherInformation",
    "Imu",
    "ImuSamples",
    "Mesh",
    "ModelPart",
    "ObjectBox",
    "Output",
    "RigImu",
    "RigSensor",
    "SceneObject",
    "Picture",
    "Measurement",
    "Scene",
    "Sensor",
    "SensorPreset",
    "DatasheetEntry",
    "Simulator",
    "Status",
    "StereoMatch",
    "StereoOptions",
    "StereoStatus",
    "StereoTest",
    "StereoTrace",
    "TofCandidate",
    "TofEdgeTest",
    "TofFilter",
    "TofFrame",
    "TofMeasurement",
    "TofMisfitTest",
    "TofOptions",
    "TofStatus",
    "TofTest",
    "TofTrace",
    "DecodedFringes",
    "FringeStatus",
    "FringeTest",
    "FringeTrace",
    "StructuredLight",
    "NoiseStep",
    "PointTrace",
    "Trajectory",
    "GroundTruth",
    "AccuracyReport",
    "AccuracyCase",
    "camera",
    "decode_tof",
    "explain_stereo",
    "explain_tof",
    "from_open3d",
    "from_trimesh",
    "imu_names",
    "list_parts",
    "load_imu",
    "load_scene",
    "load_sensor",
    "look_at",
    "match_stereo",
    "open_output",
    "output_formats",
    "pose",
    "quaternion",
    "recommended_depth_filters",
    "rig_imus",
    "sample_stereo_pair",
    "sample_tof_images",
    "sensor",
    "sensor_file",
    "sensor_names",
    "sensor_presets",
    "datasheet",
    "simulate",
    "simulate_batch",
    "simulate_imu",
    "simulate_imus",
    "simulate_iter",
    "simulate_rig",
    "surface_names",
    "verify",
]
