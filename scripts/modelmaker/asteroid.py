# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The asteroid: a cube-sphere mesh, its baked albedo and normal map, as one GLB file."""

import numpy as np

from .glb import GlbMesh, write_glb
from .images import encode_normals, encode_png
from .surface import surface, unit

CELLS = 56  # per side of a cube face
TILE, GUTTER = 256, 4  # pixels per cube face in the atlas of 3 x 2 tiles
ATLAS = np.array([3 * TILE, 2 * TILE])
# Outward axis, axis along +u, axis along +v of each cube face; u x v = outward.
FACES = np.array([
    [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
    [[-1, 0, 0], [0, -1, 0], [0, 0, 1]],
    [[0, 1, 0], [-1, 0, 0], [0, 0, 1]],
    [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
    [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
    [[0, 0, -1], [1, 0, 0], [0, -1, 0]],
])


def face_directions(face, s, t):
    """Unit directions through a cube face; s, t in 0..1 are equal steps of angle."""
    outward, along_u, along_v = FACES[face]
    a = np.tan((2.0 * s - 1.0) * np.pi / 4.0)[..., None]
    b = np.tan((2.0 * t - 1.0) * np.pi / 4.0)[..., None]
    return unit(outward + a * along_u + b * along_v)


def lattice():
    """Grid points of all faces as keys shared along the cube's edges: (unique keys, index)."""
    i, j = np.meshgrid(np.arange(CELLS + 1), np.arange(CELLS + 1), indexing="xy")
    half = CELLS * FACES
    keys = [half[f, 0] + (2 * i - CELLS)[..., None] * FACES[f, 1]
            + (2 * j - CELLS)[..., None] * FACES[f, 2] for f in range(6)]
    unique, index = np.unique(np.array(keys).reshape(-1, 3), axis=0, return_inverse=True)
    return unique, index.reshape(6, CELLS + 1, CELLS + 1)


def triangles_of(index, points):
    """Two triangles per grid cell, cut along the shorter diagonal."""
    a, b = index[:, :-1, :-1].ravel(), index[:, :-1, 1:].ravel()
    c, d = index[:, 1:, 1:].ravel(), index[:, 1:, :-1].ravel()
    first = np.sum((points[a] - points[c]) ** 2, -1) <= np.sum((points[b] - points[d]) ** 2, -1)
    one = np.where(first[:, None], np.stack([a, b, c], -1), np.stack([a, b, d], -1))
    two = np.where(first[:, None], np.stack([a, c, d], -1), np.stack([b, c, d], -1))
    return np.stack([one, two], axis=1).reshape(-1, 3), first


def vertex_normals(points, triangles):
    """Normals weighted by area."""
    p = points[triangles]
    face = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    normals = np.zeros_like(points)
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], face)
    return unit(normals)


def principal_frame(points, triangles):
    """Centre of volume and rows of the principal axes (longest first) of the closed mesh."""
    p = points[triangles]
    volumes = np.einsum("ij,ij->i", p[:, 0], np.cross(p[:, 1], p[:, 2])) / 6.0
    centre = np.einsum("i,ij->j", volumes, p.sum(axis=1) / 4.0) / volumes.sum()
    q = p - centre
    sums = q.sum(axis=1)
    volumes = np.einsum("ij,ij->i", q[:, 0], np.cross(q[:, 1], q[:, 2])) / 6.0
    spread = np.einsum("i,ij,ik->jk", volumes, sums, sums)
    spread += np.einsum("i,icj,ick->jk", volumes, q, q)
    _, vectors = np.linalg.eigh(spread)
    axes = vectors.T[::-1]
    axes[0] *= np.sign(axes[0, 0])
    axes[1] *= np.sign(axes[1, 1])
    axes[2] = np.cross(axes[0], axes[1])
    return centre, axes


def bilinear(grid, x, y):
    """Values between the points of grid[row y, column x]; clamped at its border."""
    x, y = np.clip(x, 0.0, CELLS), np.clip(y, 0.0, CELLS)
    i, j = np.minimum(x.astype(int), CELLS - 1), np.minimum(y.astype(int), CELLS - 1)
    fx, fy = (x - i)[..., None], (y - j)[..., None]
    low = grid[j, i] * (1.0 - fx) + grid[j, i + 1] * fx
    high = grid[j + 1, i] * (1.0 - fx) + grid[j + 1, i + 1] * fx
    return low * (1.0 - fy) + high * fy


def bake_face(face, point_grid, normal_grid):
    """Albedo and tangent-space normals of one tile, row 0 on top.

    The normal of the fine surface is stored in the tangent frame that a renderer interpolates over the mesh.
    """
    step = (np.arange(-1, TILE + 1) + 0.5 - GUTTER) / (TILE - 2 * GUTTER)
    s, t = np.meshgrid(step, step, indexing="xy")
    points, tone = surface(face_directions(face, s, t).reshape(-1, 3), fine=True)
    points, tone = points.reshape(TILE + 2, TILE + 2, 3), tone.reshape(TILE + 2, TILE + 2)
    along_s = points[1:-1, 2:] - points[1:-1, :-2]
    along_t = points[2:, 1:-1] - points[:-2, 1:-1]
    true = unit(np.cross(along_s, along_t))
    x, y = s[1:-1, 1:-1] * CELLS, t[1:-1, 1:-1] * CELLS
    normal = unit(bilinear(normal_grid, x, y))
    tangent = bilinear(np.gradient(point_grid, axis=1), x, y)
    tangent = unit(tangent - normal * np.sum(tangent * normal, -1, keepdims=True))
    frame = (tangent, np.cross(normal, tangent), normal)
    local = np.stack([np.sum(true * axis, -1) for axis in frame], axis=-1)
    local[..., 2] = np.maximum(local[..., 2], 0.15)
    return 0.56 + tone[1:-1, 1:-1][::-1], unit(local)[::-1]


def corner_uvs():
    """Texture coordinates of every face's grid points, v downwards as glTF has it."""
    i, j = np.meshgrid(np.arange(CELLS + 1), np.arange(CELLS + 1), indexing="xy")
    inner = (TILE - 2 * GUTTER) / CELLS
    uvs = [np.stack([f % 3 * TILE + GUTTER + inner * i,
                     (f // 3 + 1) * TILE - GUTTER - inner * j], -1) / ATLAS for f in range(6)]
    return np.array(uvs).reshape(-1, 2)


def make_asteroid(folder):
    """Writes folder/asteroid.glb."""
    keys, index = lattice()
    cube = unit(np.tan(keys / CELLS * np.pi / 4.0))
    points, _ = surface(cube, fine=False)
    triangles, _ = triangles_of(index, points)
    normals = vertex_normals(points, triangles)
    albedo, bumps = np.zeros((2 * TILE, 3 * TILE)), np.zeros((2 * TILE, 3 * TILE, 3))
    for face in range(6):
        rows = slice(face // 3 * TILE, (face // 3 + 1) * TILE)
        columns = slice(face % 3 * TILE, (face % 3 + 1) * TILE)
        albedo[rows, columns], bumps[rows, columns] = bake_face(
            face, points[index[face]], normals[index[face]])
    centre, axes = principal_frame(points, triangles)
    own = np.arange(index.size).reshape(index.shape)  # vertices are apart at the tiles' borders
    mesh = GlbMesh(
        # Steps of 2^-10 m and 2^-13: the last bits of sines differ between machines.
        positions_m=np.round((points - centre) @ axes.T * 1024.0)[index.ravel()] / 1024.0,
        normals=np.round(normals @ axes.T * 8192.0)[index.ravel()] / 8192.0,
        uvs=corner_uvs(),
        triangles=own.ravel()[local_triangles(index, points)],
    )
    write_glb(folder / "asteroid.glb", mesh, encode_png(albedo), encode_png(encode_normals(bumps)))


def local_triangles(index, points):
    """The triangles as positions in the flattened grids of the faces."""
    grids = np.arange(index.size).reshape(index.shape)
    return triangles_of(grids, points[index.ravel()])[0]
