#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Range errors over the distance, of GLIDAR and of a ray caster in single precision (Open3D 0.20, which uses Embree).

A sphere of 1 m, built of triangles, fills the picture of a camera from every distance. The ground truth is the nearest
intersection of each beam with all triangles in extended precision (80 bits), by the formula of Moeller and Trumbore
(1997), which neither of them uses in this precision.
"""

import argparse
import sys

try:
    import numpy as np

    import glidar
except ImportError as missing:
    sys.exit(f"{missing}; install GLIDAR (docs/python.md) and what scripts/requirements.txt names")

DISTANCES_M = 2.0 * 10.0 ** np.arange(0.0, 6.1, 0.5)
SIDE = 48
BORDER = 1e-9  # beams this near an edge, in barycentric coordinates, may meet either triangle
EXAMPLE = """example:
  PYTHONPATH=build/release/python build/venv/bin/python scripts/plot_accuracy.py docs/images/accuracy.png"""


def exact_hits(origin, directions, vertices, triangles):
    """(range, triangle, is near an edge) of each beam: infinite and -1 for a miss."""
    a, b, c = (vertices[triangles[:, k]].astype(np.longdouble) for k in range(3))
    p = np.cross(directions[:, None, :], (c - a)[None])
    det = ((b - a)[None] * p).sum(-1)
    s = (origin.astype(np.longdouble) - a)[None]
    q = np.cross(s, (b - a)[None])
    u = (s * p).sum(-1) / det
    v = (directions[:, None, :] * q).sum(-1) / det
    t = ((c - a)[None] * q).sum(-1) / det
    inside = np.minimum(np.minimum(u, v), 1 - u - v)
    t = np.where((inside >= 0) & (t > 0), t, np.inf)
    nearest = t.argmin(axis=1)
    rows = np.arange(len(directions))
    near_edge = (np.abs(inside) < BORDER).any(axis=1)
    ranges = t[rows, nearest]
    return ranges, np.where(np.isfinite(ranges), nearest, -1), near_edge


def open3d_hits(origin, directions, vertices, triangles):
    import open3d

    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(open3d.core.Tensor(vertices.astype(np.float32)),
                        open3d.core.Tensor(triangles.astype(np.uint32)))
    rays = np.hstack([np.broadcast_to(origin, directions.shape), directions]).astype(np.float32)
    found = scene.cast_rays(open3d.core.Tensor(rays))
    numbers = found["primitive_ids"].numpy().astype(np.int64)
    return found["t_hit"].numpy().astype(float), np.where(numbers == 0xFFFFFFFF, -1, numbers)


def glidar_hits(scene, camera, pose):
    frame = scene.simulator(camera, renderer="rays").simulate(pose, columns="all")
    numbers = np.asarray(frame.ground_truth.primitive, dtype=np.int64).ravel()
    hit = np.isfinite(frame.ground_truth.range_m.ravel())
    return np.where(hit, frame.ground_truth.range_m.ravel(), np.inf), np.where(hit, numbers, -1)


def errors(found, exact):
    """(largest range error of hits that both have, share of beams with another triangle or miss)"""
    ranges, numbers = found
    exact_ranges, exact_numbers, near_edge = exact
    counted = ~near_edge
    both = counted & (numbers >= 0) & (exact_numbers >= 0)
    largest = float(np.abs(ranges[both] - exact_ranges[both]).max())
    return largest, float((numbers != exact_numbers)[counted].mean())


def measure(distance):
    scene = glidar.Scene("builtin:sphere")
    mesh = scene.objects[0].mesh
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    way = np.array([0.36, 0.48, 0.8])
    origin = distance * way
    fov_deg = np.degrees(2.0 * np.arctan(1.1 / np.sqrt(distance**2 - 1.0)))
    camera = glidar.camera(SIDE, SIDE, fov_deg=fov_deg)
    pose = glidar.look_at(origin, (0.0, 0.0, 0.0))
    directions = np.asarray(camera.ray_directions).reshape(-1, 3) @ np.asarray(pose)[:3, :3].T
    exact = exact_hits(origin, directions.astype(np.longdouble), vertices, triangles)
    return (errors(glidar_hits(scene, camera, pose), exact),
            errors(open3d_hits(origin, directions, vertices, triangles), exact))


def plot(rows, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
    for k, (name, mark) in enumerate((("GLIDAR", "o-"), ("Open3D (Embree, single precision)", "s-"))):
        left.loglog(DISTANCES_M, [row[k][0] for row in rows], mark, label=name, markersize=4)
        right.semilogx(DISTANCES_M, [100.0 * row[k][1] for row in rows], mark, label=name, markersize=4)
    left.loglog(DISTANCES_M, 2.0**-53 * DISTANCES_M, ":", color="grey", label="rounding of double, 2^-53")
    left.set(xlabel="distance, m", ylabel="largest range error, m", title="A sphere of 1 m that fills the picture")
    right.set(xlabel="distance, m", ylabel="beams, %", title="Beams with another triangle, or a false miss")
    left.legend(fontsize="small")
    right.legend(fontsize="small")
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, epilog=EXAMPLE,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", help="PNG to write")
    options = parser.parse_args()
    rows = []
    for distance in DISTANCES_M:
        rows.append(measure(distance))
        (ours, wrong), (theirs, lost) = rows[-1]
        print(f"{distance:12.1f} m: GLIDAR {ours:.1e} m, {100 * wrong:.2f} % wrong; "
              f"Open3D {theirs:.1e} m, {100 * lost:.2f} % wrong", flush=True)
    plot(rows, options.picture)


if __name__ == "__main__":
    main()
