# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Distributions of poses: positions and orientations.

Positions are metres in the world; rotations are matrices N x 3 x 3 from the axes of the sensor (or object) to those of
the world. Like distributions of numbers, they are functions of uniform numbers and grid indices.
"""

from dataclasses import dataclass

import numpy as np

from glidar import Error
from glidar.campaign import rotations, yaml_file as yf
from glidar.campaign.distributions import Constant, read_distribution
from glidar.campaign.portable import cbrt, cos, length, sin

POSITIONS = ["point", "box", "shell", "cone", "grid", "sphere_grid"]
ORIENTATIONS = ["uniform", "look_at", "cone", "quaternion", "rotation_vector", "euler_deg"]
UP = [0.0, 0.0, 1.0]


@dataclass(frozen=True)
class Point:
    position: tuple
    dims = 0
    cells = 1

    def sample(self, u, cell):
        return np.tile(self.position, (len(u), 1)).astype(float)


@dataclass(frozen=True)
class Box:
    min: tuple
    max: tuple
    dims = 3
    cells = 1

    def sample(self, u, cell):
        low, high = np.array(self.min), np.array(self.max)
        return low + (high - low) * u


@dataclass(frozen=True)
class Shell:
    """Uniform in volume between two radii, within an angle around an axis (pi: the full sphere)."""

    centre: tuple
    axis: tuple
    half_angle_rad: float
    min_radius_m: float
    max_radius_m: float
    dims = 3
    cells = 1

    def sample(self, u, cell):
        # The volume grows with the cube of the radius, a cap with 1 - cos of its angle.
        cube = self.min_radius_m**3 + (self.max_radius_m**3 - self.min_radius_m**3) * u[:, 2]
        directions = rotations.directions_in_cone(self.axis, self.half_angle_rad, u[:, :2])
        return np.array(self.centre) + cbrt(cube)[:, None] * directions


@dataclass(frozen=True)
class BoxGrid:
    """Points of a grid; x varies fastest."""

    min: tuple
    max: tuple
    counts: tuple
    dims = 0

    @property
    def cells(self):
        return int(np.prod(self.counts))

    def sample(self, u, cell):
        cell = np.asarray(cell, np.int64)
        columns = []
        for low, high, count in zip(self.min, self.max, self.counts):
            columns.append(np.linspace(low, high, count)[cell % count])
            cell = cell // count
        return np.stack(columns, axis=1)


@dataclass(frozen=True)
class SphereGrid:
    """Evenly distributed points on a sphere: a Fibonacci lattice with half-steps at the poles (Swinbank
    and Purser, "Fibonacci grids", Q. J. R. Meteorol. Soc. 132, 2006)."""

    centre: tuple
    radius_m: float
    count: int
    dims = 0

    @property
    def cells(self):
        return self.count

    def sample(self, u, cell):
        k = np.asarray(cell, np.float64)
        z = 1.0 - (2.0 * k + 1.0) / self.count
        azimuth = np.pi * (3.0 - np.sqrt(5.0)) * k  # the golden angle
        r = np.sqrt(1.0 - z * z)
        unit = np.stack([r * cos(azimuth), r * sin(azimuth), z], axis=1)
        return np.array(self.centre) + self.radius_m * unit


@dataclass(frozen=True)
class FixedRotation:
    """The same orientation for all trials."""

    quaternion: tuple  # w x y z
    dims = 0
    cells = 1

    def sample(self, position, u, cell, boresight):
        return np.tile(rotations.matrices(np.array([self.quaternion])), (len(u), 1, 1))


@dataclass(frozen=True)
class UniformRotation:
    """Uniform over all rotations (the Haar measure of SO(3))."""

    dims = 3
    cells = 1

    def sample(self, position, u, cell, boresight):
        return rotations.matrices(rotations.uniform_quaternions(u))


@dataclass(frozen=True)
class LookAt:
    """The boresight points at a target, or along an axis, with an error within a cone. `roll_deg` rotates around the
    boresight; at 0, `up` is up in the image."""

    target: tuple | None
    axis: tuple | None
    up: tuple
    max_offset_rad: float
    roll_deg: object

    @property
    def dims(self):
        return 2 * (self.max_offset_rad > 0) + self.roll_deg.dims

    @property
    def cells(self):
        return self.roll_deg.cells

    def sample(self, position, u, cell, boresight):
        if self.target is None:
            forward = np.tile(np.array(self.axis, float), (len(u), 1))
        else:
            forward = np.array(self.target) - position
            forward[np.linalg.norm(forward, axis=1) == 0] = np.nan  # no direction, see require_finite
        if self.max_offset_rad > 0:
            forward = rotations.perturbed_directions(forward, self.max_offset_rad, u[:, :2])
            u = u[:, 2:]
        roll = np.radians(self.roll_deg.sample(u, cell))
        return rotations.look_rotations(forward, self.up, roll, boresight)


@dataclass(frozen=True)
class PoseDistribution:
    position: object
    orientation: object

    @property
    def dims(self):
        return self.position.dims + self.orientation.dims

    @property
    def cells(self):
        return self.position.cells * self.orientation.cells

    def sample(self, u, cell, boresight):
        """World_from_body, N x 4 x 4; boresight[i] is "x" or "z"."""
        cell = np.asarray(cell, np.int64)
        split = self.position.dims
        poses = np.tile(np.eye(4), (len(u), 1, 1))
        poses[:, :3, 3] = self.position.sample(u[:, :split], cell % self.position.cells)
        poses[:, :3, :3] = self.orientation.sample(
            poses[:, :3, 3], u[:, split:], cell // self.position.cells, boresight)
        return poses


def require_finite(world_from_body, what):
    """Raises Error for poses with NaN: the position equals look_at's target, so there is no direction."""
    if np.isnan(world_from_body).any():
        raise Error(what, "the position is the target of look_at", "positions apart from the target",
                    "move the target or the positions")


def _radii(field):
    if field.is_number():
        radius = yf.number(field, yf.ABOVE_ZERO)
        return radius, radius
    return yf.span(field, yf.FROM_ZERO)


def _centre(found):
    return tuple(yf.optional(found, "centre", lambda f: yf.numbers(f, 3), [0.0, 0.0, 0.0]))


def _shell(field, with_axis):
    keys = ["centre", "radius_m"] + (["axis", "half_angle_deg"] if with_axis else [])
    found = yf.require_keys(field, keys)
    axis, half_angle_deg = UP, 180.0
    if with_axis:
        axis = yf.direction(yf.need(field, found, "axis"))
        half_angle_deg = yf.number(yf.need(field, found, "half_angle_deg"), yf.CONE_DEG)
    return Shell(_centre(found), tuple(axis), np.radians(half_angle_deg),
                 *_radii(yf.need(field, found, "radius_m")))


def _box(field):
    found = yf.require_keys(field, ["min", "max"])
    low, high = (yf.numbers(yf.need(field, found, key), 3) for key in ("min", "max"))
    if any(a > b for a, b in zip(low, high)):
        yf.reject(field, f"min {low}, max {high}", "min not above max on any axis")
    return Box(tuple(low), tuple(high))


def _box_grid(field):
    found = yf.require_keys(field, ["min", "max", "counts"])
    low, high = (yf.numbers(yf.need(field, found, key), 3) for key in ("min", "max"))
    counts = [yf.whole(item, 1, 1 << 16) for item in yf.items(yf.need(field, found, "counts"), 3, 3)]
    return BoxGrid(tuple(low), tuple(high), tuple(counts))


def _sphere_grid(field):
    found = yf.require_keys(field, ["centre", "radius_m", "count"])
    return SphereGrid(_centre(found), yf.number(yf.need(field, found, "radius_m"), yf.ABOVE_ZERO),
                      yf.whole(yf.need(field, found, "count"), 1, 1 << 24))


def read_position(field):
    kind, value = yf.only_key(field, POSITIONS)
    if kind == "point":
        return Point(tuple(yf.numbers(value, 3)))
    if kind in ("shell", "cone"):
        return _shell(value, kind == "cone")
    return {"box": _box, "grid": _box_grid, "sphere_grid": _sphere_grid}[kind](value)


def _roll(found):
    return yf.optional(found, "roll_deg", lambda f: read_distribution(f, yf.ANGLE_DEG), Constant(0.0))


def _look_at(field, at_target):
    keys = ["target", "max_offset_deg"] if at_target else ["axis", "half_angle_deg"]
    found = yf.require_keys(field, keys + ["up", "roll_deg"])
    up = tuple(yf.optional(found, "up", yf.direction, UP))
    if at_target:
        target = tuple(yf.optional(found, "target", lambda f: yf.numbers(f, 3), [0.0, 0.0, 0.0]))
        max_offset_deg = yf.optional(found, "max_offset_deg", lambda f: yf.number(f, yf.CONE_DEG), 0.0)
        return LookAt(target, None, up, np.radians(max_offset_deg), _roll(found))
    axis = tuple(yf.direction(yf.need(field, found, "axis")))
    half_angle_deg = yf.number(yf.need(field, found, "half_angle_deg"), yf.CONE_DEG)
    return LookAt(None, axis, up, np.radians(half_angle_deg), _roll(found))


def _quaternion(field):
    found = yf.require_keys(field, ["w", "x", "y", "z"])
    q = np.array([yf.number(yf.need(field, found, key)) for key in "wxyz"])
    if not q.any():
        yf.reject(field, "a quaternion of length 0", "a quaternion other than 0")
    return tuple(q / length(q))


def _euler(field):
    found = yf.require_keys(field, ["roll", "pitch", "yaw"])
    angles = [yf.optional(found, key, yf.number, 0.0) for key in ("roll", "pitch", "yaw")]
    return rotations.quaternion_of_euler(*np.radians(angles))


def read_orientation(field):
    if field.value == "uniform":
        return UniformRotation()
    kind, value = yf.only_key(field, ORIENTATIONS)
    if kind == "uniform":
        yf.reject(value, "a value", "only the word: orientation: uniform")
    if kind in ("look_at", "cone"):
        return _look_at(value, kind == "look_at")
    if kind == "quaternion":
        return FixedRotation(_quaternion(value))
    if kind == "rotation_vector":
        return FixedRotation(rotations.quaternion_of_vector(yf.numbers(value, 3)))
    return FixedRotation(_euler(value))


def read_pose(field):
    found = yf.require_keys(field, ["position", "orientation"])
    position = read_position(yf.need(field, found, "position"))
    orientation = read_orientation(yf.need(field, found, "orientation"))
    return PoseDistribution(position, orientation)
