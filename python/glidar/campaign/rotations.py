# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Rotations and directions, many at a time; quaternions are w x y z, matrices world_from_body."""

import numpy as np

SMALLEST_SINE = 1e-9  # below it the roll about a line of sight is not defined


def uniform_quaternions(u):
    """N x 4 unit quaternions, uniform over SO(3), of N x 3 uniform numbers (Shoemake, "Uniform random
    rotations", Graphics Gems III, 1992)."""
    a, b = np.sqrt(1.0 - u[:, 0]), np.sqrt(u[:, 0])
    first, second = 2.0 * np.pi * u[:, 1], 2.0 * np.pi * u[:, 2]
    return np.stack([b * np.cos(second), a * np.sin(first), a * np.cos(first), b * np.sin(second)],
                    axis=1)


def matrices(q):
    """N x 3 x 3 of N x 4 unit quaternions."""
    w, x, y, z = q.T
    rows = [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
            2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
            2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]
    return np.stack(rows, axis=1).reshape(-1, 3, 3)


def quaternions(m):
    """N x 4 unit quaternions with w >= 0 of N x 3 x 3 matrices, by the greatest of the four (Shepperd,
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
    """Of a rotation vector: axis times angle in radians."""
    angle = float(np.linalg.norm(vector))
    if angle == 0.0:
        return 1.0, 0.0, 0.0, 0.0
    return (float(np.cos(angle / 2)),
            *(float(x) for x in np.sin(angle / 2) / angle * np.asarray(vector, float)))


def quaternion_of_euler(roll_rad, pitch_rad, yaw_rad):
    """About the fixed axes x, then y, then z (REP-103)."""
    q = np.array([1.0, 0.0, 0.0, 0.0])
    for axis, angle in enumerate((roll_rad, pitch_rad, yaw_rad)):
        vector = np.zeros(3)
        vector[axis] = angle
        q = product(quaternion_of_vector(vector), q)
    return tuple(float(x) for x in q)


def product(p, q):
    """The rotation q, then p."""
    pw, pv, qw, qv = p[0], np.asarray(p[1:]), q[0], np.asarray(q[1:])
    return np.array([pw * qw - pv @ qv, *(pw * qv + qw * pv + np.cross(pv, qv))])


def _beside(forward):
    """Two unit vectors that are square to each of N unit vectors and to each other."""
    helper = np.where(np.abs(forward[:, 2:]) < 0.9, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0])
    first = np.cross(helper, forward)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return first, np.cross(forward, first)


def bent(forward, half_angle_rad, u):
    """N directions, each uniform over the cap of that half-angle about its own axis: 1 - cos of the
    angle is uniform (Archimedes' hat box)."""
    forward = forward / np.linalg.norm(forward, axis=1, keepdims=True)
    # 1 - cos a = 2 sin^2(a / 2): so that narrow cones lose no digits
    half_sine = np.sin(half_angle_rad / 2.0) * np.sqrt(u[:, 0])
    angle = 2.0 * np.arcsin(half_sine)
    azimuth = 2.0 * np.pi * u[:, 1]
    first, second = _beside(forward)
    sideways = np.cos(azimuth)[:, None] * first + np.sin(azimuth)[:, None] * second
    return np.cos(angle)[:, None] * forward + np.sin(angle)[:, None] * sideways


def directions_in_cone(axis, half_angle_rad, u):
    """N unit vectors, uniform over the cap of that half-angle about one axis."""
    return bent(np.tile(np.asarray(axis, float), (len(u), 1)), half_angle_rad, u)


def looking(forward, up, roll_rad, boresight):
    """N x 3 x 3: the boresight along `forward`, `up` upwards in the image, then turned by the roll
    about the boresight, right-handed. Boresight "z": x right, y down, z forward; "x": x forward, y
    left, z up (REP-103). Where up lies along forward, another axis takes its place."""
    forward = forward / np.linalg.norm(forward, axis=1, keepdims=True)
    up = np.asarray(up, float) / np.linalg.norm(up)
    right = np.cross(forward, up)
    length = np.linalg.norm(right, axis=1, keepdims=True)
    right = np.where(length > SMALLEST_SINE, right / np.maximum(length, SMALLEST_SINE),
                     _beside(forward)[0])
    down = np.cross(forward, right)
    c, s = np.cos(roll_rad)[:, None], np.sin(roll_rad)[:, None]
    right, down = c * right + s * down, c * down - s * right
    camera = np.stack([right, down, forward], axis=2)
    body = np.stack([forward, -right, -down], axis=2)
    return np.where((np.asarray(boresight) == "x")[:, None, None], body, camera)
