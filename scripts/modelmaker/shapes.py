# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Simple solids with texture coordinates, wound counter-clockwise as seen from outside.

A Part keeps polygons of 3 or 4 corners; normals are made from it when it is written.
"""

from dataclasses import dataclass, field

import numpy as np

from .noise import fractal_noise


@dataclass
class Part:
    """Polygons over shared points; one list of corner uvs and one material name per polygon."""

    name: str
    points: np.ndarray  # (n, 3) metres
    polygons: list = field(default_factory=list)  # tuples of indices into points
    uvs: list = field(default_factory=list)  # a tuple of (u, v) per polygon, v upwards
    materials: list = field(default_factory=list)

    def add(self, polygon, uvs, material):
        """Adds a polygon without its repeated corners (at a pole, four become three)."""
        keep = [k for k in range(len(polygon)) if polygon[k] != polygon[k - 1]]
        self.polygons.append(tuple(int(polygon[k]) for k in keep))
        self.uvs.append(tuple((float(uvs[k][0]), float(uvs[k][1])) for k in keep))
        self.materials.append(material)


def rotation(axis, degrees):
    """Right-handed rotation about axis 0, 1 or 2 (x, y, z)."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    matrix = np.eye(3)
    j, k = (axis + 1) % 3, (axis + 2) % 3
    matrix[j, j], matrix[j, k], matrix[k, j], matrix[k, k] = c, -s, s, c
    return matrix


def placed(part, offset_m=(0.0, 0.0, 0.0), turn=None):
    """The part turned, then moved."""
    turn = np.eye(3) if turn is None else turn
    part.points = np.sum(part.points[:, None, :] * turn[None], axis=-1) + np.array(offset_m)
    return part


def box(name, size_m, materials, uv_per_m=None, cells=1):
    """A box about the origin. materials: one name, or six for +x -x +y -y +z -z.

    uv_per_m: texture repeats per metre, one number or six; none: a face shows the texture once.
    cells: grid cells along each edge.
    """
    materials = [materials] * 6 if isinstance(materials, str) else materials
    uv_per_m = uv_per_m if isinstance(uv_per_m, tuple) else (uv_per_m,) * 6
    frames = (((0, 1), (1, 1), (2, 1)), ((0, -1), (1, -1), (2, 1)), ((1, 1), (0, -1), (2, 1)),
              ((1, -1), (0, 1), (2, 1)), ((2, 1), (0, 1), (1, 1)), ((2, -1), (0, 1), (1, -1)))
    index, points = {}, []
    part = Part(name, np.zeros((0, 3)))

    def corner(frame, i, j):
        key = [0, 0, 0]
        for (axis, sign), steps in zip(frame, (cells, 2 * i - cells, 2 * j - cells), strict=True):
            key[axis] = sign * steps
        if tuple(key) not in index:
            index[tuple(key)] = len(points)
            points.append([key[a] / cells * size_m[a] / 2.0 for a in range(3)])
        return index[tuple(key)]

    for frame, material, per_m in zip(frames, materials, uv_per_m, strict=True):
        stretch = [1.0 if per_m is None else per_m * size_m[frame[k][0]] for k in (1, 2)]
        for j in range(cells):
            for i in range(cells):
                ring = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
                part.add([corner(frame, *at) for at in ring],
                         [(at[0] / cells * stretch[0], at[1] / cells * stretch[1]) for at in ring],
                         material)
    part.points = np.array(points)
    return part


def lathe(name, profile_m, segments, materials, repeats=(1.0, 1.0), closed=True):
    """Turns (radius, z) points about z: up the outer side, then down the inner side.

    closed: the last point joins the first, unless both lie on the axis. materials: one name or
    one per profile segment.
    """
    count = len(profile_m)
    on_axis = [r == 0.0 for r, _ in profile_m]
    loops = closed and not (on_axis[0] and on_axis[-1])
    bands = count if loops else count - 1
    materials = [materials] * bands if isinstance(materials, str) else materials
    points, rings = [], []
    for (r, z), pole in zip(profile_m, on_axis, strict=True):
        angles = 2.0 * np.pi * np.arange(1 if pole else segments) / segments
        rings.append((len(points) + np.arange(segments)) if not pole
                     else np.full(segments, len(points)))
        points += [[r * np.cos(a), r * np.sin(a), z] for a in angles]
    part = Part(name, np.array(points))
    for band in range(bands):
        low, high = rings[band], rings[(band + 1) % count]
        v = (band / bands * repeats[1], (band + 1) / bands * repeats[1])
        for k in range(segments):
            n = (k + 1) % segments
            u = (k / segments * repeats[0], (k + 1) / segments * repeats[0])
            part.add([low[k], low[n], high[n], high[k]],
                     [(u[0], v[0]), (u[1], v[0]), (u[1], v[1]), (u[0], v[1])], materials[band])
    return part


def cylinder(name, radius_m, length_m, segments, materials, repeats=(1.0, 1.0)):
    """Along +z from the origin, closed by flat ends."""
    profile = [(0.0, 0.0), (radius_m, 0.0), (radius_m, length_m), (0.0, length_m)]
    return lathe(name, profile, segments, materials, repeats)


def tube(name, path_m, radius_m, sides, material):
    """A round tube along a path (n, 3), closed by points at its ends' centres."""
    path = np.asarray(path_m, dtype=np.float64)
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=-1, keepdims=True)
    side = np.cross(along[0], np.eye(3)[np.argmin(np.abs(along[0]))])
    points = [path[0]]
    for centre, tangent in zip(path, along, strict=True):
        side = side - tangent * np.sum(side * tangent)  # carried along without twist
        side /= np.linalg.norm(side)
        other = np.cross(tangent, side)
        angles = 2.0 * np.pi * np.arange(sides) / sides
        points += [centre + radius_m * (np.cos(a) * side + np.sin(a) * other) for a in angles]
    points.append(path[-1])
    part = Part(name, np.array(points))
    rings = [np.full(sides, 0)] + [1 + sides * k + np.arange(sides) for k in range(len(path))]
    rings.append(np.full(sides, len(points) - 1))
    for band in range(len(rings) - 1):
        low, high = rings[band], rings[band + 1]
        v = (band / (len(rings) - 1), (band + 1) / (len(rings) - 1))
        for k in range(sides):
            n, u = (k + 1) % sides, (k / sides, (k + 1) / sides)
            part.add([low[k], low[n], high[n], high[k]],
                     [(u[0], v[0]), (u[1], v[0]), (u[1], v[1]), (u[0], v[1])], material)
    return part


def strut(name, start_m, end_m, radius_m, material, sides=8):
    """A straight rod."""
    return tube(name, np.linspace(start_m, end_m, 2), radius_m, sides, material)


def disc(name, radius_m, segments, material, uv_per_m):
    """A plane at z = 0, front to +z, with a flat texture. Not closed."""
    angles = 2.0 * np.pi * np.arange(segments) / segments
    rim = [[radius_m * np.cos(a), radius_m * np.sin(a), 0.0] for a in angles]
    part = Part(name, np.array([[0.0, 0.0, 0.0]] + rim))
    for k in range(segments):
        ring = (0, 1 + k, 1 + (k + 1) % segments)
        part.add(ring, [(part.points[i, :2] + radius_m) * uv_per_m for i in ring], material)
    return part


def wrinkled(part, size_m, rounding_m, swelling_m, wrinkle_m, seed):
    """A box of cells as loose foil: edges rounded, faces swollen between them, wrinkled."""
    half = np.array(size_m) / 2.0
    inner = np.clip(part.points, rounding_m - half, half - rounding_m)
    outward = part.points - inner
    outward /= np.linalg.norm(outward, axis=-1, keepdims=True)
    inside = 1.0 - (inner / (half - rounding_m)) ** 2  # 0 at a face's edge in that axis
    bulge = np.prod(np.where(np.abs(outward) > 0.5, 1.0, np.clip(inside, 0.0, 1.0)), axis=-1)
    noise = fractal_noise(part.points * 5.0, seed, 3, 0.6)
    height = bulge**0.3 * (swelling_m + wrinkle_m * noise)
    part.points = inner + outward * (rounding_m + height)[:, None]
    return part
