# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What the studies share: points on a mesh, small displacements, progress, errors of trajectories."""

import sys
import time

import numpy as np


class Progress:
    """A bar on stderr for work that takes longer than two seconds."""

    def __init__(self, name, total):
        self.name, self.total, self.done = name, total, 0
        self.start = self.last = time.monotonic()
        self.shown = False

    def step(self, count=1):
        self.done += count
        now = time.monotonic()
        if self.total == 0 or now - self.start < 2 or (now - self.last < 0.5 and self.done < self.total):
            return
        self.last, self.shown = now, True
        filled = 30 * self.done // self.total
        left_s = (now - self.start) * (self.total - self.done) / self.done
        sys.stderr.write(f"\r{self.name} [{'#' * filled:<30}] {self.done}/{self.total}, {left_s:.0f} s left   ")
        sys.stderr.flush()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.shown:
            sys.stderr.write("\n")


def wilson_percent(hits, count):
    """The ends of the 95 % interval of a share, in percent (Wilson, "Probable inference, the law of succession, and
    statistical inference", JASA 22, 1927): it holds also where none or all of few hit."""
    z, share = 1.959964, hits / count
    middle = share + z * z / (2 * count)
    half = z * np.sqrt(share * (1 - share) / count + z * z / (4 * count * count))
    return tuple(100 * (middle + side * half) / (1 + z * z / count) for side in (-1, 1))


def surface_points(vertices, triangles, count, seed=1):
    """Points spread evenly over triangles, and their normals."""
    corners = np.asarray(vertices, float)[triangles]
    a, b, c = corners.transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    doubled_areas = np.linalg.norm(normals, axis=1)
    random = np.random.default_rng(seed)
    at = random.choice(len(corners), count, p=doubled_areas / doubled_areas.sum())
    u, v = random.random((2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return a[at] + u * (b - a)[at] + v * (c - a)[at], normals[at] / doubled_areas[at, None]


def turned(axis_angle_rad):
    """The rotation matrix of an axis times its angle (Rodrigues' formula)."""
    angle = np.linalg.norm(axis_angle_rad)
    x, y, z = axis_angle_rad / angle if angle > 0 else np.zeros(3)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def axis_angle(rotation):
    """The inverse of `turned`; the axis of half a turn comes from the symmetric part."""
    skew = rotation - rotation.T
    twice_sine = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
    sine, cosine = np.linalg.norm(twice_sine) / 2, (np.trace(rotation) - 1) / 2
    angle = np.arctan2(sine, cosine)
    if sine > 1e-6:
        return twice_sine * angle / (2 * sine)
    if cosine > 0:
        return twice_sine / 2
    values, vectors = np.linalg.eigh(rotation + rotation.T)
    return angle * vectors[:, values.argmax()]


def displaced(axis_angle_rad, shift_m, middle_m=(0, 0, 0)):
    """The rigid motion that turns about a middle and then shifts."""
    result = np.eye(4)
    result[:3, :3] = turned(np.asarray(axis_angle_rad, float))
    result[:3, 3] = middle_m + np.asarray(shift_m) - result[:3, :3] @ middle_m
    return result


def aligned(positions, truth):
    """The rigid transform from positions to the ground truth with the least sum of squares (Umeyama, "Least-squares
    estimation of transformation parameters between two point patterns", PAMI 13 (1991), equations 40 to 42, no scale)."""
    middle, true_middle = positions.mean(axis=0), truth.mean(axis=0)
    u, _, vt = np.linalg.svd((truth - true_middle).T @ (positions - middle))
    keep_hand = np.diag([1, 1, np.sign(np.linalg.det(u) * np.linalg.det(vt))])
    result = np.eye(4)
    result[:3, :3] = u @ keep_hand @ vt
    result[:3, 3] = true_middle - result[:3, :3] @ middle
    return result


def position_errors(poses, truth):
    """Distances of positions from the ground truth after aligning the trajectories (N); their root mean square is the
    absolute trajectory error (Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012)."""
    motion = aligned(poses[:, :3, 3], truth[:, :3, 3])
    return np.linalg.norm(poses[:, :3, 3] @ motion[:3, :3].T + motion[:3, 3] - truth[:, :3, 3], axis=1)


def relative_errors(poses, truth, apart):
    """Errors of the motion over `apart` frames, metres and radians (N - apart) each (Sturm et al. 2012, equation 1)."""
    def motions(them):
        return np.linalg.inv(them[:-apart]) @ them[apart:]

    errors = np.linalg.inv(motions(truth)) @ motions(poses)
    angles = [np.linalg.norm(axis_angle(error[:3, :3])) for error in errors]
    return np.linalg.norm(errors[:, :3, 3], axis=1), np.array(angles)


def ways(truth, apart):
    """How long the way over `apart` frames is (N - apart), from each frame to the next."""
    steps = np.linalg.norm(np.diff(truth[:, :3, 3], axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    return along[apart:] - along[:-apart]
