# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""OSI traces, read by ASAM's own Python package."""

import numpy as np
import pytest

import glidar

trace_reader = pytest.importorskip("osi3trace.osi_trace")

NO_OBJECT = 2**64 - 1
HOST = 2**32
SCENE = """
models:
  - {model: 'builtin:box:size=4,2,1', name: van, id: 7, class: vehicle, scale: 2.0,
     pose: {position: [12, 3, 1], euler_deg: {yaw: 45}},
     motion: {twist: {velocity_m_s: [5, 0, 0], rate_deg_s: [0, 0, 10]}}}
  - {model: 'builtin:box:size=1,6,3', name: house, id: 9, class: Building, pose: {position: [-8, 0, 0]}}
  - {model: 'builtin:asteroid', name: rock, id: 4, class: rock, pose: {position: [3, -6, 0]}}
rig_pose: {position: [1, 0, 0.5]}
rig_motion: {twist: {velocity_m_s: [2, 0, 0]}}
sensors:
  - {name: roof, sensor: VLP-16, pose: {position: [0, 0, 1.5]}}
  - {name: eye, sensor: eye.yaml, pose: {position: [0.5, 0, 1], euler_deg: {roll: -90, yaw: -70}}}
"""
EYE = """
optics: {type: pinhole, width: 60, height: 40, fov_deg: 90}
rate_hz: 10
noise: [{type: range_gaussian, sigma_m: 0.01}, {type: false_alarms, rate_hz: 4.0e+5, near_m: 1, far_m: 20}]
"""


@pytest.fixture(scope="module")
def scene_file(tmp_path_factory):
    folder = tmp_path_factory.mktemp("osi")
    (folder / "eye.yaml").write_text(EYE)
    (folder / "scene.yaml").write_text(SCENE)
    return folder / "scene.yaml"


@pytest.fixture
def messages(scene_file, program, tmp_path):
    """The SensorData of 0.2 s, by sensor."""
    program("render", scene_file, "--duration", 0.2, "--seed", 5, "-o", tmp_path / "a.osi")
    return by_sensor(read(tmp_path / "a.osi"))


def read(path):
    trace = trace_reader.OSITrace(str(path), "SensorData")
    found = list(trace)
    trace.close()
    for message in found:  # nothing is unknown to OSI, and it serializes again to the same size
        assert message.IsInitialized() and not message.FindInitializationErrors()
        assert len(message.SerializeToString()) == message.ByteSize()
    return found


def by_sensor(found):
    sensors = {}
    for message in found:
        sensors.setdefault(message.sensor_id.value, []).append(message)
    return sensors


def seconds(stamp):
    assert 0 <= stamp.nanos < 1_000_000_000
    return stamp.seconds + stamp.nanos * 1e-9


def xyz(vector):
    return np.array([vector.x, vector.y, vector.z])


def rotation(angles):
    """Rz(yaw) Ry(pitch) Rx(roll), as OSI defines Orientation3d."""
    (cr, sr), (cp, sp), (cy, sy) = ((np.cos(a), np.sin(a)) for a in (angles.roll, angles.pitch, angles.yaw))
    roll = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    pitch = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    yaw = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return yaw @ pitch @ roll


def pose_of(base):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation(base.orientation), xyz(base.position)
    return matrix


def points_of(lidar):
    """The detections in the axes of the sensor."""
    spherical = np.array([[d.position.distance, d.position.azimuth, d.position.elevation] for d in lidar.detection])
    distance, azimuth, elevation = spherical.T
    level = distance * np.cos(elevation)
    return np.stack([level * np.cos(azimuth), level * np.sin(azimuth), distance * np.sin(elevation)], 1)


def truth_of(message):
    (view,) = message.sensor_view
    return view.global_ground_truth


def objects_of(message):
    truth = truth_of(message)
    return {item.id.value: item for item in [*truth.moving_object, *truth.stationary_object]}


def test_a_trace_has_every_frame_of_every_sensor_in_the_order_of_time(scene_file, program, tmp_path):
    program("render", scene_file, "--duration", 0.2, "-o", tmp_path / "a.osi")
    found = read(tmp_path / "a.osi")
    stamps = [seconds(message.timestamp) for message in found]
    assert stamps == sorted(stamps) and {m.sensor_id.value for m in found} == {0, 1}
    counters = [[m.feature_data.lidar_sensor[0].header.cycle_counter for m in group] for group in by_sensor(found).values()]
    assert counters == [[0, 1], [0, 1]]
    assert {(m.version.version_major, m.version.version_minor, m.version.version_patch) for m in found} == {(3, 8, 0)}


@pytest.mark.parametrize("sensor", [0, 1])
def test_detections_are_the_points_of_the_cloud(messages, scene_file, program, tmp_path, sensor):
    name = ("roof", "eye")[sensor]
    columns = "xyz,sigma,instance,return_source,ring,intensity"
    program("render", scene_file, "--sensor-name", name, "--duration", 0.2, "--seed", 5, "--frame", "ros", "--drop-invalid",
            "--columns", columns, "-o", tmp_path / "a.npz")  # fmt: skip
    for frame, message in enumerate(messages[sensor]):
        with np.load(tmp_path / f"a_{frame:06d}.npz") as cloud:
            (lidar,) = message.feature_data.lidar_sensor
            assert lidar.header.number_of_valid_detections == len(lidar.detection) == cloud["xyz"].shape[1] > 100
            wanted = cloud["xyz"].reshape(-1, 3)
            np.testing.assert_allclose(points_of(lidar), wanted, rtol=0, atol=1e-12 * np.abs(wanted).max() * 10)
            sources = cloud["return_source"].reshape(-1)
            has_object = np.isin(sources, [1, 2, 3]) & (cloud["instance"].reshape(-1) != 0xFFFFFFFF)
            ids = np.where(has_object, cloud["instance"].reshape(-1).astype(np.uint64), np.uint64(NO_OBJECT))
            assert [d.object_id.value for d in lidar.detection] == ids.tolist()
            assert [d.beam_id.value for d in lidar.detection] == cloud["ring"].reshape(-1).tolist()
            clutter = np.isin(sources, [4, 5, 6, 7, 8])
            assert [d.classification == 3 for d in lidar.detection] == clutter.tolist()
            sigma = np.nan_to_num(cloud["sigma"].reshape(-1))  # unknown for false alarms
            assert [d.position_rmse.distance for d in lidar.detection] == sigma.tolist()
            assert all(0 <= d.intensity <= 100 and d.existence_probability == 1 for d in lidar.detection)


def test_false_alarms_refer_to_no_object(messages):
    detections = [d for message in messages[1] for d in message.feature_data.lidar_sensor[0].detection]
    clutter = [d for d in detections if d.classification == 3]
    assert clutter and all(d.object_id.value == NO_OBJECT for d in clutter)
    assert {d.object_id.value for d in detections} >= {7, NO_OBJECT}


def test_detections_of_an_object_are_on_its_box(messages):
    """Mounting position, host vehicle and objects together: the chain of poses of a consumer."""
    for group in messages.values():
        message = group[0]  # frame 0 of the camera is one instant; the scanner's first points are too
        objects = objects_of(message)
        world_from_rig = pose_of(objects[HOST].base)
        world_from_sensor = world_from_rig @ pose_of(message.mounting_position)
        (lidar,) = message.feature_data.lidar_sensor
        points = points_of(lidar)
        ids = np.array([d.object_id.value for d in lidar.detection], np.uint64)
        on_house = points[ids == 9] if (ids == 9).any() else points[ids == 7]
        base = objects[9 if (ids == 9).any() else 7].base
        local = np.linalg.inv(pose_of(base)) @ world_from_sensor @ np.c_[on_house, np.ones(len(on_house))].T
        half = np.array([base.dimension.length, base.dimension.width, base.dimension.height]) / 2
        assert len(on_house) > 10
        # noise of 1 cm, and 0.1 s of a rig with 2 m/s
        assert (np.abs(local[:3].T) < half + 0.3).all()


def test_objects_have_boxes_poses_types_and_velocities(messages):
    message = messages[0][1]
    t = seconds(message.timestamp)
    objects = objects_of(message)
    assert set(objects) == {4, 7, 9, HOST}
    truth = truth_of(message)
    assert truth.host_vehicle_id.value == HOST == message.sensor_view[0].host_vehicle_id.value
    assert {o.id.value for o in truth.moving_object} == {7, HOST}
    van, house, rock = objects[7], objects[9], objects[4]
    assert (van.base.dimension.length, van.base.dimension.width, van.base.dimension.height) == (8, 4, 2)
    assert (house.base.dimension.length, house.base.dimension.width, house.base.dimension.height) == (1, 6, 3)
    assert (van.type, house.classification.type, rock.classification.type) == (2, 3, 1)
    assert list(van.source_reference[0].identifier) == ["van", "vehicle"]
    assert van.model_reference == "builtin:box:size=4,2,1"
    np.testing.assert_allclose(xyz(objects[HOST].base.velocity), [2, 0, 0], atol=1e-12)
    np.testing.assert_allclose(xyz(objects[HOST].base.position), [1 + 2 * t, 0, 0.5], atol=1e-9)
    assert np.isclose(np.linalg.norm(xyz(van.base.velocity)), 5, atol=1e-9)
    turned = np.deg2rad(45 + 10 * t)
    np.testing.assert_allclose([van.base.orientation.yaw, van.base.orientation.pitch], [turned, 0], atol=1e-9)
    heading = xyz(van.base.velocity) / 5
    np.testing.assert_allclose(heading, [np.cos(turned), np.sin(turned), 0], atol=1e-9)


def test_classes_have_the_types_of_osi(program, tmp_path):
    """By the names of the enumerations in ASAM's package. Parked vehicles are moving objects too."""
    vehicles = {"car": "CAR", "Van": "VAN", "truck": "HEAVY_TRUCK", "bus": "BUS", "trailer": "TRAILER", "bicycle": "BICYCLE",
                "motorcycle": "MOTORCYCLE", "train": "TRAIN", "tram": "TRAM", "vehicle": "OTHER", "small car": "SMALL_CAR",
                "scooter": "STANDUP_SCOOTER", "excavator": "WORK_MACHINE", "ship": "WATERCRAFT", "airplane": "AIRCRAFT",
                "wheelchair": "WHEELCHAIR", "semitrailer": "SEMITRAILER", "semitractor": "SEMITRACTOR",
                "compact_car": "COMPACT_CAR", "luxury_car": "LUXURY_CAR"}  # fmt: skip
    others = {"person": "PEDESTRIAN", "pedestrian": "PEDESTRIAN", "child": "PEDESTRIAN", "dog": "ANIMAL", "horse": "ANIMAL"}
    names = [*vehicles, *others, "tree", "cart"]
    models = "".join(f"  - {{model: builtin:box, name: o{i}, id: {i + 1}, class: '{name}', pose: {{position: [{3 * i + 5}, 0, 0]}}}}\n"
                     for i, name in enumerate(names))  # fmt: skip
    (tmp_path / "scene.yaml").write_text(f"models:\n{models}rig_pose: {{position: [0, 0, 0]}}\nsensors: [{{name: a, sensor: VLP-16}}]\n")
    program("render", tmp_path / "scene.yaml", "--duration", 0.1, "-o", tmp_path / "a.osi")
    objects = objects_of(read(tmp_path / "a.osi")[0])
    moving = type(truth_of(read(tmp_path / "a.osi")[0]).moving_object[0])
    for i, name in enumerate(names[: len(vehicles) + len(others)]):
        found = objects[i + 1]
        assert isinstance(found, moving), name
        if name in vehicles:
            assert found.type == moving.TYPE_VEHICLE, name
            kinds = moving.VehicleClassification.Type
            assert found.vehicle_classification.type == kinds.Value(f"TYPE_{vehicles[name]}"), name
        else:
            assert found.type == moving.Type.Value(f"TYPE_{others[name]}"), name
            assert not found.HasField("vehicle_classification")
    assert objects[len(names) - 1].classification.type == 7  # TYPE_TREE
    assert objects[len(names)].classification.type == 1  # TYPE_OTHER


def test_replays_write_the_same_trace(scene_file, program, tmp_path):
    program("stream", scene_file, "--frames", 2, "--rate", "max", "--record", tmp_path / "r.jsonl", "-o", tmp_path / "a.osi")
    program("replay", tmp_path / "r.jsonl", "-o", tmp_path / "b.osi")
    assert len(read(tmp_path / "a.osi")) >= 2
    assert (tmp_path / "a.osi").read_bytes() == (tmp_path / "b.osi").read_bytes()


def test_a_refused_run_leaves_no_trace(scene_file, program, tmp_path):
    text = program("render", scene_file, "--duration", 0.1, "-o", tmp_path / "none/a.osi", code=2)
    assert "none" in text and not list(tmp_path.iterdir())
