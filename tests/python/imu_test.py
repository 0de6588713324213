# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""IMUs: noise models by the Allan variance, ground truth, presets and rigs."""

import copy
import math
import pickle

import numpy as np
import pytest

import glidar

G = 9.80665


def clusters(values, size):
    """Means over clusters of `size` samples, (clusters, 3)."""
    count = len(values) // size
    return values[: count * size].reshape(count, size, -1).mean(axis=1)


def allan_variance(values, size):
    """From disjoint pairs of clusters, whose differences are independent for white noise and random walks, so that
    the estimate has exactly as many degrees of freedom as pairs. Returns both."""
    means = clusters(values, size)
    pairs = len(means) // 2
    differences = means[1 : 2 * pairs : 2] - means[0 : 2 * pairs : 2]
    return 0.5 * np.mean(differences**2), differences.size


def chi_square_bounds(freedom, sigmas=4.5):
    """Bounds of the ratio of an estimated variance to the true one, each exceeded with a probability of 3.4e-6:
    Wilson and Hilferty, PNAS 17 (1931) 684."""
    share = 2.0 / (9.0 * freedom)
    return tuple((1.0 - share + sign * sigmas * math.sqrt(share)) ** 3 for sign in (-1.0, 1.0))


def triad_keys(triad, **values):
    gyroscope = {"noise": "noise_density_deg_s_sqrt_hz", "walk": "random_walk_deg_s2_sqrt_hz", "bias": "bias_instability_deg_h"}
    accelerometer = {"noise": "noise_density_ug_sqrt_hz", "walk": "random_walk_ug_s_sqrt_hz", "bias": "bias_instability_ug"}
    names = gyroscope if triad == "gyroscope" else accelerometer
    return {names.get(name, name): value for name, value in values.items()}


def stationary(description, duration_s, seed=1):
    imu = glidar.Imu.from_dict({"rate_hz": 100, **description})
    return glidar.simulate_imu(imu, np.eye(4), duration_s, seed=seed)


def errors_of(samples, triad):
    if triad == "gyroscope":
        return samples.angular_velocity - samples.true_angular_velocity
    return samples.specific_force - samples.true_specific_force


UNITS = {"gyroscope": math.pi / 180.0, "accelerometer": 1e-6 * G}
SIZES = [1, 2, 5, 10, 30, 100, 300, 1000, 3000]


@pytest.mark.parametrize("triad", ["gyroscope", "accelerometer"])
def test_allan_variance_of_white_noise_has_its_density_and_slope(triad):
    density = 0.02 * UNITS[triad]
    samples = stationary({triad: triad_keys(triad, noise=0.02)}, 2000.0)
    deviations = []
    for size in SIZES:
        variance, freedom = allan_variance(errors_of(samples, triad), size)
        low, high = chi_square_bounds(freedom)
        assert low < variance / (density**2 / (size / 100.0)) < high, size  # N^2 / tau
        deviations.append(math.sqrt(variance))
    slope = np.polyfit(np.log(SIZES[:7]), np.log(deviations[:7]), 1)[0]
    assert slope == pytest.approx(-0.5, abs=0.02)


@pytest.mark.parametrize("triad", ["gyroscope", "accelerometer"])
def test_allan_variance_of_random_walk_has_its_density_and_slope(triad):
    density = 0.05 * UNITS[triad]
    samples = stationary({triad: triad_keys(triad, walk=0.05)}, 4000.0)
    deviations = []
    for size in SIZES:
        variance, freedom = allan_variance(errors_of(samples, triad), size)
        low, high = chi_square_bounds(freedom)
        expected = density**2 / 100.0 * (2 * size**2 + 1) / (6 * size)  # K^2 tau / 3 (1 + 1 / (2 n^2))
        assert low < variance / expected < high, size
        deviations.append(math.sqrt(variance))
    slope = np.polyfit(np.log(SIZES[3:8]), np.log(deviations[3:8]), 1)[0]
    assert slope == pytest.approx(0.5, abs=0.05)


def test_maximum_allan_deviation_of_the_correlated_bias_is_the_bias_instability():
    values = triad_keys("gyroscope", bias=36.0, correlation_time_s=2.0)
    samples = stationary({"gyroscope": values}, 20000.0)
    size = round(1.89 * 2.0 * 100)
    variance, pairs = allan_variance(samples.angular_velocity, size)
    low, high = chi_square_bounds(pairs / 2)  # neighbouring pairs are correlated
    assert low < variance / math.radians(36.0 / 3600.0) ** 2 < high
    assert allan_variance(samples.angular_velocity, size // 8)[0] < 0.7 * variance
    assert allan_variance(samples.angular_velocity, size * 8)[0] < 0.7 * variance


def expected_variance(keys, unit, size, rate_hz, names):
    """White noise, correlated bias (IEEE Std 952, C.1.1.5), random walk and quantisation."""
    tau = size / rate_hz
    ratio = tau / keys["correlation_time_s"]
    sigma = keys[names[1]] * unit[1] / 0.6173642831443085
    correlated = sigma**2 * 2.0 / ratio * (1.0 - (3.0 - 4.0 * math.exp(-ratio) + math.exp(-2.0 * ratio)) / (2.0 * ratio))
    white = (keys[names[0]] * unit[0]) ** 2 / tau
    walk = (keys[names[2]] * unit[0]) ** 2 * tau / 3.0
    return white + correlated + walk + (keys[names[3]] * unit[2]) ** 2 / 12.0 / size


PRESET_KEYS = {
    "gyroscope": (
        ("noise_density_deg_s_sqrt_hz", "bias_instability_deg_h", "random_walk_deg_s2_sqrt_hz", "resolution_deg_s"),
        (math.pi / 180.0, math.pi / 180.0 / 3600.0, math.pi / 180.0),
    ),
    "accelerometer": (
        ("noise_density_ug_sqrt_hz", "bias_instability_ug", "random_walk_ug_s_sqrt_hz", "resolution_mg"),
        (1e-6 * G, 1e-6 * G, 1e-3 * G),
    ),
}


@pytest.mark.parametrize("name", ["ADIS16448", "BMI088", "ICM-20948"])
def test_presets_have_the_allan_deviation_of_their_numbers(name):
    imu = glidar.load_imu(name)
    keys = imu.to_dict()
    samples = glidar.simulate_imu(imu, np.eye(4), 1500.0, seed=7)
    for triad, (names, units) in PRESET_KEYS.items():
        for tau in (0.1, 0.5, 2.0):
            size = round(tau * imu.rate_hz)
            variance, freedom = allan_variance(errors_of(samples, triad), size)
            low, high = chi_square_bounds(freedom)
            expected = expected_variance(keys[triad], units, size, imu.rate_hz, names)
            assert 0.98 * low < variance / expected < 1.02 * high, (triad, tau)


def test_presets_are_listed_and_differ():
    assert glidar.imu_names() == ["ADIS16448", "BMI088", "ICM-20948"]
    assert len({glidar.load_imu(name) for name in glidar.imu_names()}) == 3
    with pytest.raises(glidar.Error, match="did you mean BMI088"):
        glidar.load_imu("BMI08")


def test_imus_survive_dicts_copies_and_pickles():
    for name in glidar.imu_names():
        imu = glidar.load_imu(name)
        assert glidar.Imu.from_dict(imu.to_dict()) == imu
        assert pickle.loads(pickle.dumps(imu)) == imu
        assert copy.deepcopy(imu) == imu
    assert glidar.load_imu("BMI088").without_errors() != glidar.load_imu("BMI088")


def test_at_rest_reads_gravity_upwards_and_in_space_nothing():
    imu = glidar.load_imu("BMI088").without_errors()
    assert glidar.simulate_imu(imu, np.eye(4), 0.01).specific_force.tolist() == [[0, 0, G]] * 2
    space = glidar.simulate_imu(imu, np.eye(4), 0.01, gravity_m_s2=[0, 0, 0])
    assert not space.specific_force.any() and not space.angular_velocity.any()


def test_samples_are_the_same_in_parts():
    imu = glidar.load_imu("ADIS16448")
    whole = glidar.simulate_imu(imu, np.eye(4), 2.0)
    second = glidar.simulate_imu(imu, np.eye(4), 1.0, start_s=1.0, turned_on_s=0.0)
    assert len(whole) == 400 and len(second) == 200
    assert np.array_equal(whole.angular_velocity[200:], second.angular_velocity)
    assert np.array_equal(whole.accelerometer_bias[200:], second.accelerometer_bias)
    assert whole.t_ns[200] == second.t_ns[0] == 1_000_000_000


def test_poses_are_those_of_the_trajectory():
    times = np.linspace(0.0, 2.0, 9)
    poses = [glidar.pose([math.sin(t), t, 0], wxyz=[math.cos(t), 0, 0, math.sin(t)]) for t in times]
    spline = glidar.Trajectory.timed(times, poses, interpolation="spline")
    samples = glidar.simulate_imu("BMI088", spline, 2.0)
    assert np.array_equal(samples.world_from_imu, spline.poses_at(samples.t_ns / 1e9))
    middle = samples.true_angular_velocity[150:250]
    assert middle[:, 2] == pytest.approx(2.0, abs=0.01)
    assert pickle.loads(pickle.dumps(spline)) == spline
    assert spline != glidar.Trajectory.timed(times, poses)
    with pytest.raises(glidar.Error, match="interpolation"):
        glidar.Trajectory.timed(times, poses, interpolation="cubic")


SCENE = {
    "models": [{"model": "builtin:box"}],
    "sensors": [{"name": "lidar", "sensor": "VLP-16"}],
    "imus": [
        {"name": "imu", "imu": "BMI088", "pose": {"position": [0.5, 0, 0]}},
        {"name": "ideal", "imu": {"rate_hz": 50}, "pose": {"position": [0.5, 0, 0]}},
    ],
    "rig_pose": {"position": [0, 0, 1]},
    "rig_motion": {"spin": {"rate_rad_s": [0, 0, 2]}},
    "gravity_m_s2": [0, 0, -1.62],
}


def test_rigs_carry_imus_on_lever_arms():
    scene = glidar.Scene.from_dict(SCENE)
    rig = glidar.rig_imus(scene)
    assert list(rig) == ["imu", "ideal"] and rig["ideal"].number == 1
    samples = glidar.simulate_imus(scene, 1.0)
    assert len(samples["imu"]) == 200 and len(samples["ideal"]) == 50
    assert samples["ideal"].specific_force == pytest.approx(np.tile([-2.0, 0, 1.62], (50, 1)), abs=1e-12)
    assert scene == glidar.Scene.from_dict(SCENE)
    other = {**SCENE, "imus": SCENE["imus"][:1]}
    assert scene != glidar.Scene.from_dict(other)
    with pytest.raises(glidar.Error, match="no IMUs"):
        glidar.simulate_imus(glidar.Scene("builtin:box"), 1.0)


def test_errors_name_the_field():
    for keys, text in [
        ({"rate_hz": 0}, "rate_hz"),
        ({"gyroscope": {"noise": 1}}, "gyroscope.*noise"),
        ({"accelerometer": {"range_g": -1}}, "accelerometer.range_g"),
    ]:
        with pytest.raises(glidar.Error, match=text):
            glidar.Imu.from_dict(keys)
    twice = {**SCENE, "imus": [{"name": "lidar", "imu": "BMI088"}]}
    with pytest.raises(glidar.Error, match="given twice"):
        glidar.Scene.from_dict(twice)
    with pytest.raises(glidar.Error, match="seed"):
        glidar.simulate_imu("BMI088", np.eye(4), 1.0, seed=-1)


def test_splines_agree_with_scipy():
    """Positions with the natural cubic spline; rotations with RotationSpline, whose ends differ, in the middle."""
    interpolate = pytest.importorskip("scipy.interpolate")
    transform = pytest.importorskip("scipy.spatial.transform")
    times = np.arange(81) * 0.1 + 0.02 * np.sin(np.arange(81))
    vectors = np.stack([np.sin(times), np.cos(1.3 * times), 0.5 * times], axis=1)
    rotations = transform.Rotation.from_rotvec(vectors)
    poses = np.tile(np.eye(4), (81, 1, 1))
    poses[:, :3, :3] = rotations.as_matrix()
    poses[:, :3, 3] = vectors[:, [2, 0, 1]]
    spline = glidar.Trajectory.timed(times, poses, interpolation="spline")
    seen = np.round(np.linspace(times[1], times[-2], 333), 9)
    found = spline.poses_at(seen)
    natural = interpolate.CubicSpline(np.round(times, 9), poses[:, :3, 3], bc_type="natural")
    assert np.abs(found[:, :3, 3] - natural(seen)).max() < 1e-8
    expected = transform.RotationSpline(np.round(times, 9), rotations)(seen).as_matrix()
    middle = slice(120, 210)
    assert np.abs(found[middle, :3, :3] - expected[middle]).max() < 1e-8
