# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Distributions of numbers and poses against closed forms."""

import hashlib

import numpy as np
import pytest
from scipy import stats
from scipy.spatial.transform import Rotation

from glidar.campaign import distributions as d, philox, poses, rotations

N = 50_000
P = 1e-4  # significance level of the tests; the seeds are fixed


def uniforms(dims, name="test"):
    return philox.uniforms(11, np.arange(N), name, dims)


def sampled(distribution):
    return distribution.sample(uniforms(distribution.dims), np.arange(N) % distribution.cells)


def cone_law(half_angle_rad):
    """The distribution of the cosine of the angle to the axis: uniform from cos(half angle) to 1."""
    return stats.uniform(np.cos(half_angle_rad), 1 - np.cos(half_angle_rad)).cdf


def test_uniform_log_uniform_and_truncated_normal_samples_follow_their_distributions():
    assert stats.kstest(sampled(d.Uniform(-2, 5)), stats.uniform(-2, 7).cdf).pvalue > P
    assert stats.kstest(np.log(sampled(d.LogUniform(1e-3, 10))),
                        stats.uniform(np.log(1e-3), np.log(1e4)).cdf).pvalue > P
    normal = sampled(d.Normal(1.0, 2.0, 0.0, 4.0))
    assert stats.kstest(normal, stats.truncnorm(-0.5, 1.5, 1.0, 2.0).cdf).pvalue > P
    assert normal.min() >= 0 and normal.max() <= 4


@pytest.mark.parametrize("least, most", [
    (0.5, np.inf), (5.0, np.inf), (7.5, np.inf), (7.5, 300.0), (7.99, np.inf), (6.0, 6.001), (-0.5, 7.5),
    (-np.inf, -7.5), (-300.0, -7.9)])
def test_normals_truncated_in_the_tails_follow_their_distribution(least, most):
    u = np.sort(uniforms(1), axis=0)
    samples = d.Normal(3.0, 2.0, 3.0 + 2.0 * least, 3.0 + 2.0 * most).sample(u, np.zeros(N))
    assert (np.diff(samples) >= 0).all()  # the inverse distribution function
    x, (low, high) = (samples - 3.0) / 2.0, (least, most)
    if least > 0:  # mirrored, because logarithms are precise below the mean
        x, low, high, u = -x, -most, -least, 1.0 - u
    # (Phi(x) - Phi(low)) / (Phi(high) - Phi(low)) from logarithms, since Phi is as small as 1e-15
    log = stats.norm.logcdf
    law = (np.exp(log(x) - log(high)) - np.exp(log(low) - log(high))) / -np.expm1(log(low) - log(high))
    assert np.abs(law - u[:, 0]).max() < 1e-9
    assert stats.kstest(law, "uniform").pvalue > P
    assert samples.min() >= 3.0 + 2.0 * least and samples.max() <= 3.0 + 2.0 * most


def test_frequencies_of_choices_follow_their_weights():
    counts = np.bincount(sampled(d.Choice((0, 1, 2), (0.2, 0.5, 0.3))))
    assert stats.chisquare(counts, N * np.array([0.2, 0.5, 0.3])).pvalue > P


def test_shells_are_uniform_in_volume_and_direction():
    shell = poses.Shell((1.0, 2.0, 3.0), (0, 0, 1), np.pi, 2.0, 5.0)
    offset = sampled(shell) - [1, 2, 3]
    radius = np.linalg.norm(offset, axis=1)
    assert stats.kstest(radius**3, stats.uniform(8, 117).cdf).pvalue > P
    for axis in range(3):  # by Archimedes, each coordinate of a uniform direction is uniform
        assert stats.kstest(offset[:, axis] / radius, stats.uniform(-1, 2).cdf).pvalue > P
    assert abs(stats.spearmanr(radius, offset[:, 2] / radius).statistic) < 0.02


@pytest.mark.parametrize("half_angle_deg", [1e-4, 10.0, 120.0])
def test_cones_are_uniform_over_their_cap(half_angle_deg):
    axis = np.array([1.0, -2.0, 0.5])
    half = np.radians(half_angle_deg)
    unit = sampled(poses.Shell((0, 0, 0), tuple(axis), half, 1.0, 1.0))
    axis = axis / np.linalg.norm(axis)
    sine = np.linalg.norm(np.cross(unit, axis), axis=1)
    angle = np.arctan2(sine, unit @ axis)
    law = stats.uniform(0, np.sin(half / 2) ** 2).cdf  # (1 - cos a) / 2 = sin^2(a / 2)
    assert stats.kstest(np.sin(angle / 2) ** 2, law).pvalue > P
    assert angle.max() <= half * (1 + 1e-9)


def test_boxes_are_uniform():
    box = sampled(poses.Box((0, -1, 2), (1, 1, 2)))
    assert stats.kstest(box[:, 1], stats.uniform(-1, 2).cdf).pvalue > P
    assert (box[:, 2] == 2).all()


def test_uniform_rotations_follow_the_haar_measure():
    u = uniforms(3)
    m = poses.UniformRotation().sample(np.zeros((N, 3)), u, np.zeros(N), "z")
    assert np.abs(m @ m.transpose(0, 2, 1) - np.eye(3)).max() < 1e-12
    assert np.abs(np.linalg.det(m) - 1).max() < 1e-12
    # Every column is a uniform direction, and the angle of rotation has density (1 - cos a) / pi.
    for row in range(3):
        for column in range(3):
            assert stats.kstest(m[:, row, column], stats.uniform(-1, 2).cdf).pvalue > P
    angle = np.arccos(np.clip((np.trace(m, axis1=1, axis2=2) - 1) / 2, -1, 1))
    assert stats.kstest(angle, lambda a: (a - np.sin(a)) / np.pi).pvalue > P
    # The Haar measure is invariant under rotations.
    turned = Rotation.from_rotvec([0.3, 1.0, -0.7]).as_matrix() @ m
    angle = Rotation.from_matrix(turned).magnitude()
    assert stats.kstest(angle, lambda a: (a - np.sin(a)) / np.pi).pvalue > P


def test_matrices_and_quaternions_agree_with_scipy():
    q = rotations.uniform_quaternions(uniforms(3))
    m = Rotation.from_quat(q[:, [1, 2, 3, 0]]).as_matrix()
    assert np.abs(rotations.matrices(q) - m).max() < 1e-14
    back = rotations.quaternions(m)
    assert (back[:, 0] >= 0).all()
    assert np.abs(np.abs((back * q).sum(axis=1)) - 1).max() < 1e-12
    half_turns = np.array([np.diag([1.0, -1, -1]), np.diag([-1.0, 1, -1]), np.diag([-1.0, -1, 1])])
    assert np.array_equal(rotations.quaternions(half_turns), np.eye(4)[1:])
    euler = rotations.quaternion_of_euler(0.1, -0.5, 2.0)
    expected = Rotation.from_euler("xyz", [0.1, -0.5, 2.0]).as_quat()[[3, 0, 1, 2]]
    assert np.abs(np.array(euler) - expected).max() < 1e-14


@pytest.mark.parametrize("boresight, forward_axis, up_axis", [("z", 2, -1), ("x", 0, 2)])
def test_look_at_points_the_boresight_at_the_target_with_up_upwards(boresight, forward_axis, up_axis):
    aimed = poses.LookAt((1.0, 0.0, 0.0), None, (0, 0, 1), 0.0, d.Constant(0.0))
    position = np.array([[6.0, 0.0, 0.0], [1.0, 4.0, 3.0], [1.0, 0.0, 9.0]])
    m = aimed.sample(position, np.empty((3, 0)), np.zeros(3), np.full(3, boresight))
    forward = np.array([1.0, 0, 0]) - position
    forward /= np.linalg.norm(forward, axis=1)[:, None]
    assert np.abs(m[:, :, forward_axis] - forward).max() < 1e-12
    assert np.abs(np.linalg.det(m) - 1).max() < 1e-12
    up = m[:, :, 2] if up_axis == 2 else -m[:, :, 1]
    assert up[0, 2] == pytest.approx(1) and up[1, 2] > 0.7
    assert np.isfinite(m[2]).all()  # vertical line of sight: any roll is valid


def test_roll_rotates_about_the_boresight_and_max_offset_deg_perturbs_it():
    rolled = poses.LookAt((0, 0, 0), None, (0, 0, 1), 0.0, d.Constant(90.0))
    m = rolled.sample(np.array([[-5.0, 0, 0]]), np.empty((1, 0)), np.zeros(1), np.array(["z"]))[0]
    # Unrolled, x is right (world -y) and y down (world -z); a right-handed quarter turn about z
    # maps x to the former y.
    assert np.allclose(m, np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]]))
    off = poses.LookAt((0, 0, 0), None, (0, 0, 1), np.radians(20), d.Uniform(-180, 180))
    position = np.tile([0.0, -3.0, 0.0], (N, 1))
    m = off.sample(position, uniforms(off.dims), np.zeros(N), np.full(N, "x"))
    assert stats.kstest(m[:, 1, 0], cone_law(np.radians(20))).pvalue > P


def test_sphere_grids_are_even_and_box_grids_vary_x_fastest():
    grid = poses.SphereGrid((0, 0, 0), 2.0, 1000)
    unit = grid.sample(np.empty((1000, 0)), np.arange(1000)) / 2.0
    assert np.abs(np.linalg.norm(unit, axis=1) - 1).max() < 1e-12
    assert np.abs(unit.mean(axis=0)).max() < 1e-3
    assert np.abs(unit.T @ unit / 1000 - np.eye(3) / 3).max() < 1e-3
    distance = np.arccos(np.clip(unit @ unit.T - 2 * np.eye(1000), -1, 1)).min(axis=1)
    assert distance.min() > 0.7 * np.sqrt(4 * np.pi / 1000)
    box = poses.BoxGrid((0, 0, 5), (1, 2, 5), (2, 3, 1))
    points = box.sample(np.empty((6, 0)), np.arange(6))
    assert points.tolist() == [[0, 0, 5], [1, 0, 5], [0, 1, 5], [1, 1, 5], [0, 2, 5], [1, 2, 5]]


def test_samples_have_the_same_bytes_on_every_machine():
    position = np.tile([0.0, -3.0, 0.0], (1000, 1))
    cells, sensors = np.arange(1000), np.full(1000, "x")
    found = hashlib.sha256()
    for distribution in (d.Uniform(-2, 5), d.LogUniform(1e-3, 10), d.Normal(1.0, 2.0, 0.0, 4.0), d.Normal(0, 1, 5, 9),
                         poses.Shell((1.0, 2.0, 3.0), (0, 0.6, 0.8), 0.7, 2.0, 5.0), poses.SphereGrid((0, 0, 0), 2.0, 1000)):
        found.update(distribution.sample(uniforms(distribution.dims)[:1000], cells).tobytes())
    for distribution in (poses.UniformRotation(), poses.FixedRotation(rotations.quaternion_of_euler(0.3, -0.2, 1.0)),
                         poses.LookAt((0.5, 0, 0), None, (0, 0.1, 1), 0.35, d.Uniform(-180, 180))):
        found.update(distribution.sample(position, uniforms(distribution.dims)[:1000], cells, sensors).tobytes())
    assert found.hexdigest() == "5f254fc8e77b4ea02607959009e27aeb4e6127b310172f87ebc10705618b329d"
