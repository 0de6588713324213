# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes parts as Wavefront OBJ and their materials as MTL."""

import numpy as np

CREASE_COSINE = np.cos(np.radians(50.0))


def corner_normals(part):
    """One unit normal per corner of each polygon, smooth across edges below the crease angle."""
    areas = []
    for polygon in part.polygons:
        p = part.points[list(polygon)]
        diagonals = (p[2] - p[0], p[3] - p[1]) if len(p) == 4 else (p[1] - p[0], p[2] - p[0])
        areas.append(0.5 * np.cross(*diagonals))
    areas = np.array(areas)
    faces = areas / np.linalg.norm(areas, axis=-1, keepdims=True)
    around = [[] for _ in part.points]
    for f, polygon in enumerate(part.polygons):
        for corner in polygon:
            around[corner].append(f)
    normals = []
    for f, polygon in enumerate(part.polygons):
        near = [np.array(around[corner]) for corner in polygon]
        near = [g[np.sum(faces[g] * faces[f], axis=-1) > CREASE_COSINE] for g in near]
        sums = np.array([areas[g].sum(axis=0) for g in near])
        normals.append(sums / np.linalg.norm(sums, axis=-1, keepdims=True))
    return normals


class Pool:
    """Lines written once each; index() counts from 1, as OBJ does."""

    def __init__(self, key, digits):
        self.key, self.digits = key, digits
        self.index_of = {}

    def index(self, numbers):
        text = " ".join(short(number, self.digits) for number in numbers)
        return self.index_of.setdefault(text, len(self.index_of) + 1)

    def lines(self):
        return [f"{self.key} {text}" for text in self.index_of]


def short(number, digits):
    """Fixed digits without trailing zeros or a negative zero."""
    text = f"{number:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def write_obj(path, parts, comment, materials=None):
    """One object per part, one usemtl per run of a material; polygons become triangles.

    materials: name of the MTL file; none: that of path.
    """
    points, uvs, normals = Pool("v", 5), Pool("vt", 4), Pool("vn", 4)
    faces = []
    for part in parts:
        faces.append(f"o {part.name}")
        made = corner_normals(part)
        order = sorted(range(len(part.polygons)), key=lambda f: part.materials[f])
        material = None
        for f in order:
            if part.materials[f] != material:
                material = part.materials[f]
                faces.append(f"usemtl {material}")
            keys = [f"{points.index(part.points[c])}/{uvs.index(uv)}/{normals.index(n)}"
                    for c, uv, n in zip(part.polygons[f], part.uvs[f], made[f], strict=True)]
            for k in range(1, len(keys) - 1):
                faces.append(f"f {keys[0]} {keys[k]} {keys[k + 1]}")
    head = [f"# {line}" for line in comment] + [f"mtllib {materials or path.stem + '.mtl'}"]
    lines = head + points.lines() + uvs.lines() + normals.lines() + faces
    path.write_text("\n".join(lines) + "\n", encoding="ascii", newline="\n")


def write_mtl(path, materials, comment):
    """materials: name -> {statement: value}, in the order in which they are written."""
    lines = [f"# {line}" for line in comment]
    for name, statements in materials.items():
        lines += ["", f"newmtl {name}"] + [f"{key} {value}" for key, value in statements.items()]
    path.write_text("\n".join(lines) + "\n", encoding="ascii", newline="\n")
