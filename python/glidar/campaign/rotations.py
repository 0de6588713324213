# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Rotations and directions, vectorised; quaternions are w x y z, matrices world_from_body."""

import numpy as np

from glidar.campaign.portable import arcsin, cos, length, sin

MIN_SINE = 1e-9  # below it the roll around a line of sight is undefined


def uniform_quaternions(u):
    """N x 4 unit quaternions, uniform over SO(3), from N x 3 uniform numbers (Shoemake, "Uniform random
    rotations", Graphics Gems III, 1992)."""
    a, b = np.sqrt(1.0 - u[:, 0]), np.sqrt(u[:, 0])
    first, second = 2.0 * np.pi * u[:, 1], 2.0 * np.pi * u[:, 2]
    return np.stack([b * cos(second), a * sin(first), a * cos(first), b * sin(second)],
                    axis=1)


def matrices(q):
    """N x 3 x 3 rotation matrices from N x 4 unit quaternions."""
    w, x, y, z = q.T
    rows = [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
            2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
            2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]
    return np.stack(rows, axis=1).reshape(-1, 3, 3)


def quaternions(m):
    """N x 4 unit quaternions with w >= 0 from N x 3 x 3 matrices, using the largest component (Shepperd,
    "Quaternion from rotation matrix", J. Guidance and Control 1, 1978)."""
    m = np.asarray(m, float)
    trace = np.trace(m, axis1=1, axis2=2)
    squares = np.stack([trace, m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]], axis=1)
    best = np.argmax(squares, axis=1)
    wx, wy, wz = m[:, 2, 1] - m[:, 1, 2], m[:, 0, 2] - m[:, 2, 0], m[:, 1, 0] - m[:, 0, 1]
    xy, xz, yz = m[:, 1, 0] + m[:, 0, 1], m[:, 0, 2] + m[:, 2, 0], m[:, 2, 1] + m[:, 1, 2]
    d = 1.0 + 2.0 * squares[:, 1:] - trace[:, None]
    rows = np.stack([np.stack([1.0 + trace, wx, wy, wz], 1), np.stack([wx, d[:, 0], xy, xz], 1),
                     np.stack([wy, xy, d[:, 1], yz], 1), np.stack([wz, xz, yz, d[:, 2]], 1)], axis=1)
    q = rows[np.arange(len(m)), best]
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    return np.where(q[:, :1] < 0, -q, q)


def quaternion_of_vector(vector):
    """The quaternion of a rotation vector: axis times angle in radians."""
    angle = float(length(vector))
    if angle == 0.0:
        return 1.0, 0.0, 0.0, 0.0
    return (float(cos(angle / 2)),
            *(float(x) for x in sin(angle / 2) / angle * np.asarray(vector, float)))


def quaternion_of_euler(roll_rad, pitch_rad, yaw_rad):
    """The quaternion of rotations about the fixed axes x, then y, then z (REP-103)."""
    q = np.array([1.0, 0.0, 0.0, 0.0])
    for axis, angle in enumerate((roll_rad, pitch_rad, yaw_rad)):
        vector = np.zeros(3)
        vector[axis] = angle
        q = product(quaternion_of_vector(vector), q)
    return tuple(float(x) for x in q)


def product(p, q):
    """The product p q: rotates by q, then by p."""
    pw, pv, qw, qv = p[0], np.asarray(p[1:]), q[0], np.asarray(q[1:])
    return np.array([pw * qw - (pv * qv).sum(), *(pw * qv + qw * pv + np.cross(pv, qv))])


def _perpendicular_pair(forward):
    """Two unit vectors perpendicular to each of N unit vectors and to each other."""
    helper = np.where(np.abs(forward[:, 2:]) < 0.9, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0])
    first = np.cross(helper, forward)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return first, np.cross(forward, first)


def perturbed_directions(forward, half_angle_rad, u):
    """N directions, each uniform over the cap of that half-angle around one of the N axes: 1 - cos of the
    angle is uniform (Archimedes)."""
    forward = forward / np.linalg.norm(forward, axis=1, keepdims=True)
    # 1 - cos a = 2 sin^2(a / 2), which is precise for narrow cones
    half_sine = sin(half_angle_rad / 2.0) * np.sqrt(u[:, 0])
    angle = 2.0 * arcsin(half_sine)
    azimuth = 2.0 * np.pi * u[:, 1]
    first, second = _perpendicular_pair(forward)
    sideways = cos(azimuth)[:, None] * first + sin(azimuth)[:, None] * second
    return cos(angle)[:, None] * forward + sin(angle)[:, None] * sideways


def directions_in_cone(axis, half_angle_rad, u):
    """N unit vectors, uniform over the cap of that half-angle around one axis."""
    return perturbed_directions(np.tile(np.asarray(axis, float), (len(u), 1)), half_angle_rad, u)


def look_rotations(forward, up, roll_rad, boresight):
    """N x 3 x 3: the boresight along `forward`, `up` upwards in the image, then rotated by the roll around the
    boresight, right-handed. Boresight "z": x right, y down, z forward; "x": x forward, y left, z up (REP-103). Where
    up is parallel to forward, another axis is used."""
    forward = forward / np.linalg.norm(forward, axis=1, keepdims=True)
    up = np.asarray(up, float) / length(up)
    right = np.cross(forward, up)
    sine = np.linalg.norm(right, axis=1, keepdims=True)
    right = np.where(sine > MIN_SINE, right / np.maximum(sine, MIN_SINE),
                     _perpendicular_pair(forward)[0])
    down = np.cross(forward, right)
    c, s = cos(roll_rad)[:, None], sin(roll_rad)[:, None]
    right, down = c * right + s * down, c * down - s * right
    camera = np.stack([right, down, forward], axis=2)
    body = np.stack([forward, -right, -down], axis=2)
    return np.where((np.asarray(boresight) == "x")[:, None, None], body, camera)
