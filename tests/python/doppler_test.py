# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Radial velocities as arrays, columns and files."""

import pickle

import numpy as np
import pytest

import glidar

ROLL_TO_X = [[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]]  # a camera that looks along x
SENSOR_SPEED, WALL_SPEED = 12.0, 3.0


@pytest.fixture(scope="module")
def scene():
    """A wall before a camera."""
    return glidar.Scene("builtin:box:size=1,40,40")


def measure(scene, sensor, **options):
    """The camera drives towards the wall, in its own axes along z, and the wall moves away along x."""
    start = np.eye(4)
    start[0, 3] = 20.0
    wall = glidar.Trajectory.twist(start, linear_m_s=[WALL_SPEED, 0, 0])
    approaching = glidar.Trajectory.twist(np.array(ROLL_TO_X, float), linear_m_s=[0, 0, SENSOR_SPEED])
    return glidar.simulate(scene, sensor, approaching, objects=[wall], **options)


def camera(**doppler):
    return glidar.camera(40, 30, fov_deg=50.0, doppler=doppler)


def cosines(sensor):
    return sensor.ray_directions[..., 2]


@pytest.fixture(scope="module")
def frame(scene):
    return measure(scene, camera(), columns="all")


def test_a_moving_wall_has_the_relative_speed_times_the_cosine(frame):
    expected = (WALL_SPEED - SENSOR_SPEED) * cosines(camera())
    np.testing.assert_allclose(frame.radial_velocity_m_s, expected, rtol=0, atol=1e-13)
    assert np.array_equal(frame.radial_velocity_m_s, frame.ground_truth.radial_velocity_m_s)
    assert not frame.radial_velocity_m_s.flags.writeable


def test_it_is_the_difference_of_ranges_of_the_same_point(scene):
    """Of two frames 20 ms apart: the mean velocity of the interval, which a constant relative velocity nearly is."""
    sensor = glidar.camera(40, 30, fov_deg=50.0, rate_hz=50.0, doppler={})
    one = measure(scene, sensor, columns="all")
    step_s = 1 / 50
    points = one.cloud(["true_xyz"])["true_xyz"].reshape(-1, 3)
    moved = points + step_s * np.array([0, 0, WALL_SPEED - SENSOR_SPEED])  # in the axes of the camera
    difference = (np.linalg.norm(moved, axis=1) - np.linalg.norm(points, axis=1)) / step_s
    # the second derivative of the range is v^2 sin^2 / R, below 81 * 0.38 / 19 m/s^2, times half a step
    np.testing.assert_allclose(one.radial_velocity_m_s.ravel(), difference, rtol=0, atol=0.5 * step_s * 81 * 0.38 / 19)


def test_a_static_scene_has_exactly_none(scene):
    still = glidar.simulate(glidar.Scene("builtin:asteroid"), camera())
    hit = still.status == glidar.Status.hit
    assert (still.radial_velocity_m_s[hit] == 0).all() and hit.any()
    assert np.isnan(still.radial_velocity_m_s[~hit]).all() and (~hit).any()


def test_errors_have_the_stated_deviation_steps_and_limit(scene):
    noisy = measure(scene, camera(sigma_m_s=0.05), seed=4)
    error = noisy.radial_velocity_m_s - (WALL_SPEED - SENSOR_SPEED) * cosines(camera())
    assert abs(error.mean()) < 5 * 0.05 / np.sqrt(error.size)
    assert abs(error.std() - 0.05) < 5 * 0.05 / np.sqrt(2 * error.size)
    folded = measure(scene, camera(step_m_s=0.5, max_m_s=4.0)).radial_velocity_m_s
    assert np.array_equal(folded, 0.5 * np.round(2 * folded))
    assert (folded >= -4).all() and (folded < 4).all()
    true = (WALL_SPEED - SENSOR_SPEED) * cosines(camera())
    assert np.abs((folded - true + 4) % 8 - 4).max() <= 0.25 + 1e-12


def test_columns_are_those_of_the_frame(frame):
    cloud = frame.cloud("radial_velocity,true_radial_velocity")
    assert cloud["radial_velocity"].dtype == np.float64
    assert np.array_equal(cloud["radial_velocity"], frame.radial_velocity_m_s)
    assert np.array_equal(cloud["true_radial_velocity"], frame.ground_truth.radial_velocity_m_s)


def test_a_sensor_without_doppler_has_the_ground_truth_only(scene):
    plain = glidar.camera(40, 30, fov_deg=50.0)
    frame = measure(scene, plain, columns="all")
    assert (frame.ground_truth.radial_velocity_m_s < 0).all()
    assert np.isnan(frame.cloud("all")["radial_velocity"]).all()
    with pytest.raises(glidar.Error, match="radial_velocity_m_s: the sensor does not measure it"):
        frame.radial_velocity_m_s  # noqa: B018
    for action in (lambda: frame.cloud(["radial_velocity"]), lambda: frame.save("a.pcd", columns=["xyz", "radial_velocity"])):
        with pytest.raises(glidar.Error, match="'depth camera' does not measure it; allowed: true_radial_velocity"):
            action()
    with pytest.raises(glidar.Error, match="radial_velocity: the sensor does not measure it"):
        frame.bird_eye(colour_by="radial_velocity")
    with pytest.raises(glidar.Error, match="ground_truth.radial_velocity_m_s: not kept"):
        measure(scene, plain).ground_truth.radial_velocity_m_s  # noqa: B018


def test_files_have_the_columns(frame, tmp_path):
    names = ["xyz", "radial_velocity", "true_radial_velocity"]
    frame.save(tmp_path / "a.npz", columns=names)
    with np.load(tmp_path / "a.npz") as stored:
        assert np.array_equal(stored["radial_velocity"], frame.radial_velocity_m_s)
    frame.save(tmp_path / "a.csv", columns=names)
    table = np.genfromtxt(tmp_path / "a.csv", delimiter=",", names=True)
    assert np.array_equal(table["radial_velocity"], frame.radial_velocity_m_s.ravel())
    for suffix in ("pcd", "ply"):
        frame.save(tmp_path / f"a.{suffix}", columns=names)
        assert b"true_radial_velocity" in (tmp_path / f"a.{suffix}").read_bytes()[:1000]
    frame.save(tmp_path / "a.bev.png", colour_by="radial_velocity")
    assert (tmp_path / "a.bev.png").stat().st_size > 1000


def test_clouds_in_bags_have_it_when_requested(frame, tmp_path):
    rosbags = pytest.importorskip("rosbags.highlevel")
    frame.save(tmp_path / "a.mcap", columns=["xyz", "radial_velocity"])
    with rosbags.AnyReader([tmp_path / "a.mcap"]) as reader:
        (link,) = [c for c in reader.connections if c.msgtype.endswith("PointCloud2")]
        (_, _, raw) = next(reader.messages([link]))
        message = reader.deserialize(raw, link.msgtype)
    offset = {field.name: field.offset for field in message.fields}["radial_velocity"]
    points = message.data.reshape(-1, message.point_step)
    velocities = points[:, offset : offset + 8].copy().view("<f8").ravel()
    assert np.array_equal(velocities, frame.radial_velocity_m_s.ravel())


def test_osi_has_it_positive_towards_the_sensor(scene, tmp_path, program):
    traces = pytest.importorskip("osi3trace.osi_trace")
    (tmp_path / "scene.yaml").write_text(
        "models: [{model: 'builtin:box:size=1,40,40', pose: {position: [20, 0, 0]}}]\n"
        "sensor: {optics: {type: pinhole, width: 8, height: 6, fov_deg: 20}, doppler: {}}\n"
        "sensor_pose: {position: [0, 0, 0], euler_deg: {roll: -90, yaw: -90}}\n"
        "sensor_motion: {twist: {velocity_m_s: [0, 0, 5]}}\n"
    )
    program("render", tmp_path / "scene.yaml", "-o", tmp_path / "a.osi", "--columns", "radial_velocity", "-o", tmp_path / "a.npz")
    trace = traces.OSITrace(str(tmp_path / "a.osi"), "SensorData")
    detections = next(iter(trace)).feature_data.lidar_sensor[0].detection
    with np.load(tmp_path / "a.npz") as stored:
        assert [d.radial_velocity for d in detections] == (-stored["radial_velocity"]).ravel().tolist()
    assert all(4.8 < d.radial_velocity <= 5 for d in detections)
    trace.close()


def test_frames_and_sensors_survive_pickling(frame):
    again = pickle.loads(pickle.dumps(frame))
    assert again == frame
    assert np.array_equal(again.radial_velocity_m_s, frame.radial_velocity_m_s)
    sensor = camera(sigma_m_s=0.03, signal_sigma_m_s=0.1, step_m_s=0.01, max_m_s=60.0)
    assert sensor.to_dict()["doppler"] == {"sigma_m_s": 0.03, "signal_sigma_m_s": 0.1, "step_m_s": 0.01, "max_m_s": 60.0}
    assert glidar.Sensor.from_dict(sensor.to_dict()) == pickle.loads(pickle.dumps(sensor)) == sensor


def test_traces_have_the_velocity_at_every_stage(scene):
    sensor = glidar.camera(8, 6, doppler={"sigma_m_s": 0.1}, noise=[{"type": "range_gaussian", "sigma_m": 0.01}])
    frame = measure(scene, sensor)
    trace = frame.explain(17)
    measured = frame.radial_velocity_m_s.ravel()[17]
    assert trace.measured.radial_velocity_m_s == trace.steps[0].after.radial_velocity_m_s == measured
    assert f"{measured:+.6f} m/s" in str(trace)
    assert "doppler   " in str(trace) and "positive away from the sensor" in str(trace)


def test_wrong_keys_are_reported():
    with pytest.raises(glidar.Error, match="did you mean 'sigma_m_s'"):
        camera(sigma=1.0)
    with pytest.raises(glidar.Error, match="step_m_s"):
        camera(step_m_s=2.0, max_m_s=1.0)
