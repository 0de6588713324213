#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Casts the same rays into the same scenes by GLIDAR and other ray casters, and compares hits and ranges with known answers.

Answers are closed forms (plane, boxes, aimed points) or double-precision brute force, whose range is refined in long
double. Every program gets what it is most exact with: MuJoCo primitives and bodies with poses, GLIDAR instances, the
others vertices in the world frame. A hit is wrong if it is missing, invented, or off by more than a thousandth of its
range; rays that pass within 1e-7 of an edge are not counted, unless they are aimed at it. --write renews the table
and the picture of docs/peers.md.
"""

import argparse
import hashlib
import importlib
import itertools
import math
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

import glidar

ROOT = Path(__file__).resolve().parent.parent
PAGE, PICTURE = ROOT / "docs" / "peers.md", ROOT / "docs" / "images" / "peers.png"
MARK = "<!-- peers.py -->\n"
WRONG = 1e-3  # of the range
EDGE = 1e-7   # of the triangle
PLACEMENT = np.eye(4)


class Part:
    """A mesh in single precision with its poses in the world; `box` and `plane` are what it is as a primitive."""

    def __init__(self, vertices, triangles, poses=(PLACEMENT, ), box=None, plane=False):
        self.vertices = np.asarray(vertices, np.float32).astype(float)
        self.triangles = np.asarray(triangles, np.uint32)
        self.poses, self.box, self.plane = [np.asarray(pose, float) for pose in poses], box, plane

    def world(self):
        """Vertices and triangles of all instances."""
        count = len(self.vertices)
        vertices = [self.vertices @ pose[:3, :3].T + pose[:3, 3] for pose in self.poses]
        return np.vstack(vertices), np.vstack([self.triangles.astype(np.int64) + i * count for i in range(len(vertices))])


class Scene:
    """Rays from one origin with their true ranges; `truth` is None where brute force finds them."""

    def __init__(self, name, parts, origin, directions, truth=None, counted=None):
        self.name, self.parts, self.origin = name, parts, np.asarray(origin, float)
        self.directions = directions / np.linalg.norm(directions, axis=1)[:, None]
        self.truth, self.counted = (truth, counted) if truth is not None else brute_force(self)
        if self.counted is None:
            self.counted = np.ones(len(self.truth), bool)

    def world(self):
        vertices, triangles, offset = [], [], 0
        for part in self.parts:
            v, t = part.world()
            vertices.append(v)
            triangles.append(t + offset)
            offset += len(v)
        return np.vstack(vertices), np.vstack(triangles)


def brute_force(scene):
    """Ranges (NaN: miss) by Moeller and Trumbore over all triangles near a ray, and which rays are clear of edges."""
    vertices, triangles = scene.world()
    corners = (vertices - scene.origin)[triangles]
    middle = corners.mean(axis=1)
    radius2 = (np.linalg.norm(corners - middle[:, None], axis=2).max(axis=1) * (1 + 1e-9)) ** 2
    distance2 = (middle ** 2).sum(axis=1)
    ranges, clear = np.full(len(scene.directions), np.nan), np.ones(len(scene.directions), bool)
    for i, direction in enumerate(scene.directions):
        along = middle @ direction
        near = corners[(distance2 - along ** 2 <= radius2)]
        a, ab, ac = near[:, 0], near[:, 1] - near[:, 0], near[:, 2] - near[:, 0]
        p = np.cross(direction, ac)
        determinant = (ab * p).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            u = (-a * p).sum(axis=1) / determinant
            q = np.cross(-a, ab)
            v = q @ direction / determinant
            t = (ac * q).sum(axis=1) / determinant
        inside = np.minimum(np.minimum(u, v), 1 - u - v)
        hits = np.flatnonzero((inside >= 0) & (t > 0))
        first = t[hits].min() if len(hits) else np.inf
        clear[i] = not ((np.abs(inside) < EDGE) & (t > 0) & (t <= first * (1 + 1e-6))).any()
        if len(hits):
            best = hits[np.argmin(t[hits])]
            exact = near[best].astype(np.longdouble)
            normal = np.cross(exact[1] - exact[0], exact[2] - exact[0])
            ranges[i] = float((normal * exact[0]).sum() / (normal * direction.astype(np.longdouble)).sum())
    return ranges, clear


def box_ranges(boxes, origin, directions):
    """Ranges of axis-parallel boxes (middle, half size), NaN: miss."""
    nearest = np.full(len(directions), np.inf)
    with np.errstate(divide="ignore"):
        inverse = 1 / directions
    for middle, half in boxes:
        low, high = (middle - origin - half) * inverse, (middle - origin + half) * inverse
        enter, leave = np.minimum(low, high).max(axis=1), np.maximum(low, high).min(axis=1)
        nearest = np.where((enter <= leave) & (enter > 0), np.minimum(nearest, enter), nearest)
    return np.where(np.isfinite(nearest), nearest, np.nan)


def near_box_edges(boxes, origin, directions):
    """Rays for which boxes that are a little larger or smaller give another answer."""
    larger = box_ranges([(m, h * (1 + EDGE)) for m, h in boxes], origin, directions)
    smaller = box_ranges([(m, h * (1 - EDGE)) for m, h in boxes], origin, directions)
    return (np.isnan(larger) != np.isnan(smaller)) | (np.abs(larger - smaller) > WRONG * np.abs(larger) / 10)


# --- Scenes ----------------------------------------------------------------------------------------------------------

BOX_CORNERS = np.array(list(itertools.product((-1, 1), repeat=3)), float)
BOX_TRIANGLES = np.array([(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6),
                          (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)])


def icosphere(radius, divisions):
    """A geodesic sphere of 20 x 4^divisions triangles."""
    golden = (1 + 5 ** 0.5) / 2
    points = [(0, a, b * golden) for a in (-1, 1) for b in (-1, 1)]
    points = np.array([np.roll(p, k) for k in range(3) for p in points])
    points /= np.linalg.norm(points[0])
    near = np.linalg.norm(points[:, None] - points[None], axis=2) < 1.1
    faces = [f for f in itertools.combinations(range(12), 3) if near[f[0], f[1]] and near[f[1], f[2]] and near[f[0], f[2]]]
    faces = np.array([f if np.linalg.det(points[list(f)]) > 0 else f[::-1] for f in faces])
    for _ in range(divisions):
        edges = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        unique, index = np.unique(edges, axis=0, return_inverse=True)
        middles = points[unique].mean(axis=1)
        ab, bc, ca = (index.reshape(3, -1) + len(points))
        points = np.vstack([points, middles / np.linalg.norm(middles, axis=1)[:, None]])
        a, b, c = faces.T
        faces = np.vstack([np.stack(s, axis=1) for s in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return radius * points, faces


def cone(rng, count, axis, half_deg):
    """Directions evenly within an angle of an axis."""
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    side = np.linalg.svd(axis[None])[2][1:]
    z = rng.uniform(np.cos(np.radians(half_deg)), 1, count)
    turn = rng.uniform(0, 2 * np.pi, count)
    xy = np.sqrt(1 - z ** 2)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return z[:, None] * axis + xy @ side


def moved(position, scale=1.0):
    pose = np.eye(4)
    pose[:3, :3] *= scale
    pose[:3, 3] = position
    return pose


def box_scene(name, middles, half, origin, directions):
    """Boxes of one size as instances."""
    half = float(np.float32(half))
    boxes = [(np.asarray(middle, float), np.full(3, half)) for middle in middles]
    unit = directions / np.linalg.norm(directions, axis=1)[:, None]
    truth = box_ranges(boxes, origin, unit)
    part = Part(half * BOX_CORNERS, BOX_TRIANGLES, [moved(middle) for middle in middles], box=half)
    return Scene(name, [part], origin, directions, truth, ~near_box_edges(boxes, np.asarray(origin, float), unit))


def plane_scene(name, rng, count, low_deg, high_deg):
    """A ground of 400 km seen from 2 m at these angles of incidence."""
    incidence, turn = np.radians(rng.uniform(low_deg, high_deg, count)), rng.uniform(0, 2 * np.pi, count)
    directions = np.stack([np.sin(incidence) * np.cos(turn), np.sin(incidence) * np.sin(turn), -np.cos(incidence)], axis=1)
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    size = 2.0 ** 18
    ground = Part([(-size, -size, 0), (size, -size, 0), (size, size, 0), (-size, size, 0)], [(0, 1, 2), (0, 2, 3)], plane=True)
    return Scene(name, [ground], (0.5, 0.25, 2), directions, 2 / -directions[:, 2])


def aimed_scene(rng, count):
    """From inside a sphere at its vertices and the middles of its edges: there is no way out."""
    vertices, faces = icosphere(2.0, 4)
    vertices = vertices.astype(np.float32).astype(float)
    edges = np.unique(np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]]]), axis=1), axis=0)
    targets = np.vstack([vertices, vertices[edges].mean(axis=1)])
    targets = targets[rng.permutation(len(targets))[:count]]
    origin = np.array([0.125, -0.25, 0.0625])
    return Scene("edges and vertices", [Part(vertices, faces)], origin, targets - origin, np.linalg.norm(targets - origin, axis=1))


def model_scene(rng, path, count):
    """A model seen from 1.6 times its size."""
    model = glidar.Scene(str(path))
    mesh = model.objects[0].mesh
    middle, size = mesh.vertices.mean(axis=0), np.ptp(mesh.vertices, axis=0).max()
    origin = middle + 1.6 * size * np.array([0.48, 0.36, 0.8])
    return Scene(path.stem.split("_")[0].replace("bun", "bunny"), [Part(mesh.vertices, mesh.triangles)], origin,
                 cone(rng, count, middle - origin, 20))


def scenes_of(rng, count, models):
    """The scenes, from the easy to the hard."""
    yield plane_scene("plane, 0 to 60 degrees", rng, count, 0, 60)
    yield plane_scene("plane, grazing, 89 to 89.99", rng, count, 89, 89.99)
    yield Scene("sphere", [Part(*icosphere(2.0, 4))], (6, 1, 2), cone(rng, count, (-6, -1, -2), 22))
    yield aimed_scene(rng, count)
    grid = [(4.0 * x - 22, 4.0 * y - 22, 4.0 * z - 12) for x in range(12) for y in range(12) for z in range(7)][:996]
    yield box_scene("996 boxes", grid, 0.5, (0.1, 0.2, 0.3), cone(rng, count, (0, 0, 1), 180))
    for path in models:
        yield model_scene(rng, path, max(count // 10, 20))
    planet = Part(*icosphere(6_371_000.0, 5))
    yield Scene("planet from 400 km", [planet], (6_771_000, 1000, 2000), cone(rng, count // 4, (-1, 0, 0), 60))
    yield box_scene("boxes 10 km apart", [(0, 0, 0), (10_000, 0, 0)], 0.5, (9_996, 0.1, 0.2), cone(rng, count, (1, 0, 0), 8))
    yield box_scene("UTM, 5,400 km from the origin", [(500_000, 5_400_000, 300)], 0.5, (499_995, 5_400_000.1, 300.2),
                    cone(rng, count, (1, 0, 0), 7))
    for size in (1e-6, 1e-3, 1e3, 1e9):
        yield box_scene(f"box of {size:g} m", [(0, 0, 0)], size / 2, (5 * size, 0.1 * size, 0.2 * size), cone(rng, count, (-1, 0, 0), 7))


# --- Programs --------------------------------------------------------------------------------------------------------

class Glidar:
    name = "GLIDAR"

    def __init__(self, scene, threads=0):
        model = glidar.Scene()
        for k, part in enumerate(scene.parts):
            first = model.add_mesh(glidar.Mesh(part.vertices, part.triangles), name=f"part {k}", pose=part.poses[0])
            if len(part.poses) > 1:
                model.add_instances(first, np.array(part.poses[1:]))
        sensor = glidar.Sensor.from_dict({"optics": {"type": "table", "directions": scene.directions[None]}})
        self.simulator = glidar.Simulator(model, sensor, threads=threads, renderer="rays")
        self.pose = moved(scene.origin)

    def cast(self):
        return self.simulator.simulate(self.pose, columns=["range"]).range_m.reshape(-1)


class MuJoCo:
    name = "MuJoCo"

    def __init__(self, scene):
        mujoco = importlib.import_module("mujoco")
        spec = mujoco.MjSpec()
        for k, part in enumerate(scene.parts):
            if not part.plane and part.box is None:
                spec.add_mesh(name=f"m{k}", uservert=part.vertices.astype(np.float32).ravel().tolist(),
                              userface=part.triangles.ravel().tolist(), inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL)
            for pose in part.poses:
                if part.plane:
                    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], pos=pose[:3, 3])
                elif part.box is not None:
                    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[part.box] * 3, pos=pose[:3, 3])
                else:
                    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=f"m{k}", pos=pose[:3, 3])
        self.mujoco, self.model = mujoco, spec.compile()
        self.data = mujoco.MjData(self.model)
        mujoco.mj_forward(self.model, self.data)
        self.origin, self.directions = scene.origin.copy(), np.ascontiguousarray(scene.directions).ravel()
        self.count = len(scene.directions)

    def cast(self):
        ids, ranges = np.zeros(self.count, np.int32), np.zeros(self.count)
        self.mujoco.mj_multiRay(self.model, self.data, self.origin, self.directions, None, True, -1, ids, ranges, None,
                                self.count, self.mujoco.mjMAXVAL * 1e10)
        return np.where(ranges < 0, np.nan, ranges)


class Open3D:
    name = "Open3D"

    def __init__(self, scene, threads=0):
        self.open3d = importlib.import_module("open3d")
        vertices, triangles = scene.world()
        self.scene, self.threads = self.open3d.t.geometry.RaycastingScene(nthreads=threads), threads
        self.scene.add_triangles(self.open3d.core.Tensor(vertices.astype(np.float32)),
                                 self.open3d.core.Tensor(triangles.astype(np.uint32)))
        rays = np.hstack([np.broadcast_to(scene.origin, scene.directions.shape), scene.directions])
        self.rays = self.open3d.core.Tensor(rays.astype(np.float32))

    def cast(self):
        ranges = self.scene.cast_rays(self.rays, nthreads=self.threads)["t_hit"].numpy().astype(float)
        return np.where(np.isfinite(ranges), ranges, np.nan)


class Trimesh:
    name = "trimesh, embreex"

    def __init__(self, scene):
        trimesh = importlib.import_module("trimesh")
        importlib.import_module("embreex")
        self.mesh = trimesh.Trimesh(*scene.world(), process=False)
        self.origins = np.broadcast_to(scene.origin, scene.directions.shape).copy()
        self.origin, self.directions = scene.origin, scene.directions

    def cast(self):
        points, rays, _ = self.mesh.ray.intersects_location(self.origins, self.directions, multiple_hits=False)
        ranges = np.full(len(self.directions), np.nan)
        ranges[rays] = np.linalg.norm(points - self.origin, axis=1)
        return ranges


class Warp:
    name = "Warp, CPU"
    kernel = None

    def __init__(self, scene):
        wp = importlib.import_module("warp")
        wp.config.quiet = True
        wp.init()
        if Warp.kernel is None:
            Warp.kernel = warp_kernel(wp)
        vertices, triangles = scene.world()
        self.wp, self.count = wp, len(scene.directions)
        self.mesh = wp.Mesh(points=wp.array(vertices, dtype=wp.vec3, device="cpu"),
                            indices=wp.array(triangles.astype(np.int32).ravel(), dtype=wp.int32, device="cpu"))
        self.origin = wp.vec3(*scene.origin.astype(np.float32))
        self.directions = wp.array(scene.directions, dtype=wp.vec3, device="cpu")
        self.ranges = wp.zeros(self.count, dtype=wp.float32, device="cpu")

    def cast(self):
        self.wp.launch(Warp.kernel, dim=self.count, device="cpu",
                       inputs=[self.mesh.id, self.origin, self.directions], outputs=[self.ranges])
        ranges = self.ranges.numpy().astype(float)
        return np.where(ranges < 0, np.nan, ranges)


def warp_kernel(wp):
    def cast_rays(mesh: wp.uint64, origin: wp.vec3, directions: wp.array(dtype=wp.vec3), ranges: wp.array(dtype=wp.float32)):
        i = wp.tid()
        query = wp.mesh_query_ray(mesh, origin, directions[i], wp.float32(1.0e38))
        ranges[i] = wp.where(query.result, query.t, wp.float32(-1.0))
    return wp.kernel(cast_rays)


PROGRAMS = (Glidar, MuJoCo, Open3D, Trimesh, Warp)


# --- What other casters do not have -----------------------------------------------------------------------------------------

def moving_target():
    """Greatest distance from the surface of a box at 20 m/s, of the points of a VLP-16 that turns at 10 Hz: with each
    beam's own time, and with one pose for the frame, as programs without time have it."""
    size, speed, begin = 4.0, 20.0, np.array([10.0, -1.0, 0.0])
    scene = glidar.Scene.from_dict({"models": [{"model": "builtin:box", "scale": size, "pose": {"position": begin.tolist()},
                                                "motion": {"twist": {"velocity_m_s": [0, speed, 0]}}}]})
    half = np.ptp(scene.objects[0].mesh.vertices, axis=0) * size / 2
    frame = glidar.simulate(scene, glidar.load_sensor("VLP-16").ground_truth(), np.eye(4))
    cloud = frame.cloud(["xyz", "time"], drop_invalid=True)
    distances = []
    for time_s in (1e-9 * cloud["time"].astype(float), np.zeros(len(cloud["time"]))):
        middle = begin + np.outer(time_s, (0, speed, 0))
        distances.append(np.abs((np.abs(cloud["xyz"] - middle) - half).max(axis=1)).max())
    return tuple(distances)


def rectangle(low, high, x):
    """A wall at x that faces the origin, from low to high in y, 200 m high."""
    corners = [(x, low, -100), (x, high, -100), (x, high, 100), (x, low, 100)]
    return glidar.Mesh(np.array(corners, float), np.array([(0, 2, 1), (0, 3, 2)], np.uint32))


def signal_over_incidence():
    """Greatest relative error of signals of a wall, 20 m high and 2 m away, at 0 to 89 degrees: cos / range^2."""
    incidence = np.radians(np.linspace(0, 89, 90))
    sensor = {"optics": {"type": "table", "directions": [np.stack([np.cos(incidence), np.sin(incidence), 0 * incidence], axis=1)]},
              "lidar_equation": {"reference_reflectance": 1.0, "reference_range_m": 1e5}}
    scene = glidar.Scene()
    scene.add_mesh(rectangle(-1e3, 1e3, 2), name="wall")
    signals = glidar.simulate(scene, glidar.Sensor.from_dict(sensor), np.eye(4)).intensity.reshape(-1).astype(float)
    return np.abs(signals / signals[0] / np.cos(incidence) ** 3 - 1).max()


def shares_at_an_edge(rings):
    """Greatest error of the shares of a footprint's signal on both sides of an edge, which crosses it in 81 steps. The
    walls are at 10 and 12 m; the share of a Gaussian of 1/e^2 radius w beyond d is (1 - erf(d sqrt(2) / w)) / 2."""
    divergence, near, far, worst = 3e-3, 10.0, 12.0, 0.0
    sensor = glidar.Sensor.from_dict({
        "optics": {"type": "table", "directions": [[[1, 0, 0]]]}, "receiver": {"returns": ["first", "last"]},
        "footprint": {"divergence_mrad": 1e3 * divergence, "rings": rings},
        "lidar_equation": {"reference_reflectance": 0.8, "reference_range_m": 1e5}})  # that of surfaces without a material
    for offset in np.linspace(-1, 1, 81):  # in radii
        edge = offset * divergence / 2 * near
        scene = glidar.Scene()
        scene.add_mesh(rectangle(-100, edge, near), name="near")
        scene.add_mesh(rectangle(-100, 100, far), name="far")
        frame = glidar.simulate(scene, sensor, np.eye(4))
        for wall, share in ((near, 0.5 + 0.5 * math.erf(offset * 2 ** 0.5)), (far, 0.5 - 0.5 * math.erf(offset * 2 ** 0.5))):
            at = np.abs(frame.range_m - wall) < 0.1
            worst = max(worst, abs(frame.intensity[at].sum() * (wall / 1e5) ** 2 - share))
    return worst


def digests(scenes):
    """SHA-256 of GLIDAR's ranges in all scenes, by each number of threads."""
    scenes = list(scenes)
    return {hashlib.sha256(b"".join(Glidar(scene, threads).cast().tobytes() for scene in scenes)).hexdigest()
            for threads in (1, 2, 5)}


def same_bytes(flags):
    """The instruction sets of this processor, and whether they give the same bytes, each with 1, 2 and 5 threads."""
    found = {}
    for isa in ("baseline", "avx2", "avx512"):
        done = subprocess.run([sys.executable, __file__, "--digest", "--rays", str(flags.rays // 10), *map(str, flags.models)],
                              env={**os.environ, "GLIDAR_ISA": isa}, capture_output=True, text=True, check=False)
        if done.returncode == 0:
            found[isa] = done.stdout.strip()
        elif "GLIDAR_ISA" not in done.stderr:  # else the processor lacks it
            raise RuntimeError(done.stderr)
    return list(found), len({word for line in found.values() for word in line.split()}) == 1


def facts(flags):
    own_time, one_pose = moving_target()
    sets, are_same = same_bytes(flags)
    return (f"- VLP-16 at 10 Hz, box at 20 m/s: points are at most {own_time:.0e} m from the surface at their own time. With one pose "
            f"per frame, as in a caster without time, they would be up to {one_pose:.1f} m away.\n"
            f"- Signal of a wall from 0 to 89 degrees of incidence: at most {signal_over_incidence():.0e} from the range equation. The others "
            f"report no signal.\n"
            f"- A footprint on the edge of a step, both sides of which are returns: their shares of the signal are at most "
            f"{shares_at_an_edge(1):.2f} from those of a Gaussian beam with 7 sub-rays, {shares_at_an_edge(3):.2f} with 37 and "
            f"{shares_at_an_edge(6):.3f} with 127. A single ray, as of the others, has one return, and is up to 0.5 off.\n"
            f"- Ranges of all scenes with 1, 2 and 5 threads and {', '.join(sets)}: {'the same bytes' if are_same else 'DIFFERENT BYTES'}.\n")


# --- Comparison ------------------------------------------------------------------------------------------------------

def compare(scene, ranges):
    """Wrong hits, and the greatest error of the others in metres."""
    counted = scene.counted
    truth, found = scene.truth[counted], ranges[counted]
    error = np.abs(found - truth)
    wrong = (np.isnan(truth) != np.isnan(found)) | (error > WRONG * truth)
    good = ~wrong & ~np.isnan(truth)
    return int(wrong.sum()), float(error[good].max()) if good.any() else np.nan


def rays_per_second(program, count):
    """By processor time, the median of three casts."""
    times = []
    for _ in range(3):
        start = time.process_time()
        program.cast()
        times.append(time.process_time() - start)
    return count / max(sorted(times)[1], 1e-9)


def measure(scene, kinds):
    """For each program (wrong, error, rays per second) or the reason why there is none."""
    results = {}
    for kind in kinds:
        try:
            program = kind(scene)
            ranges = program.cast()
            results[kind.name] = (*compare(scene, ranges), rays_per_second(program, len(ranges)))
        except ImportError as missing:
            results[kind.name] = f"not installed: {missing.name}"
        except (ValueError, RuntimeError) as refused:
            results[kind.name] = f"refused: {str(refused).splitlines()[0]}"
    return results


def cell(result):
    if isinstance(result, str):
        return result
    wrong, error, speed = result
    return f"{wrong} / {error:.0e} / {speed / 1e6:.2g}" if np.isfinite(error) else f"{wrong} / – / {speed / 1e6:.2g}"


def table(rows, names):
    lines = ["| scene | rays | " + " | ".join(names) + " |", "|---|---|" + "---|" * len(names)]
    for scene, results in rows:
        lines.append(f"| {scene.name} | {int(scene.counted.sum())} | " + " | ".join(cell(results[name]) for name in names) + " |")
    return "\n".join(lines) + "\n"


def draw(rows, names, path):
    """The worst range error of every program in every scene, as a share of the range; a cross: wrong hits."""
    pyplot = importlib.import_module("matplotlib.pyplot")
    figure, axes = pyplot.subplots(figsize=(9, 0.42 * len(rows) + 1.4), layout="constrained")
    for k, name in enumerate(names):
        points = [(i, r[name]) for i, (_, r) in enumerate(rows) if not isinstance(r[name], str)]
        scale = [np.nanmean(rows[i][0].truth) for i, _ in points]
        x = [max(r[1] / s, 1e-17) if np.isfinite(r[1]) else np.nan for (_, r), s in zip(points, scale)]
        y = np.array([i for i, _ in points]) + 0.12 * (k - (len(names) - 1) / 2)
        drawn = axes.plot(x, y, "o", label=name, markersize=5)[0]
        wrong = np.array([r[0] > 0 for _, r in points])
        at = np.where(np.isfinite(x), x, 1e-3)
        axes.plot(at[wrong], y[wrong], "x", color=drawn.get_color(), markersize=11)
    axes.set_xscale("log")
    axes.set_yticks(range(len(rows)), [scene.name for scene, _ in rows])
    axes.invert_yaxis()
    axes.set_xlabel("worst range error as a share of the mean range; a cross: wrong hits")
    axes.grid(axis="x", alpha=0.3)
    axes.legend(loc="upper center", bbox_to_anchor=(0.4, 1.16 if len(rows) < 10 else 1.09), ncols=len(names), frameon=False)
    figure.savefig(path, dpi=110, metadata={"Software": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*", type=Path, metavar="MODEL", help="models that are scenes too, such as bun_zipper.ply")
    parser.add_argument("--rays", type=int, default=20_000, help="in most scenes [20000]")
    parser.add_argument("--only", nargs="+", choices=[kind.__name__ for kind in PROGRAMS], help="programs [all]")
    parser.add_argument("--digest", action="store_true", help="print a hash of GLIDAR's ranges only")
    parser.add_argument("--write", action="store_true", help="renew docs/peers.md and its picture")
    flags = parser.parse_args()
    if flags.write and (flags.only or not flags.models):
        parser.error("--write needs all programs, and models")
    if flags.digest:
        print(*digests(scenes_of(np.random.default_rng(1), flags.rays, flags.models)))
        return 0
    kinds = [kind for kind in PROGRAMS if not flags.only or kind.__name__ in flags.only]
    names = [kind.name for kind in kinds]
    rows = []
    for scene in scenes_of(np.random.default_rng(1), flags.rays, flags.models):
        rows.append((scene, measure(scene, kinds)))
        print(f"{scene.name}: " + "; ".join(f"{name} {cell(rows[-1][1][name])}" for name in names), flush=True)
    alone = facts(flags)
    print(alone)
    if flags.write:
        before, _, after = PAGE.read_text(encoding="utf-8").split(MARK)
        PAGE.write_text(before + MARK + table(rows, names) + "\n" + alone + MARK + after, encoding="utf-8")
        draw(rows, names, PICTURE)
    ours = [results["GLIDAR"] for _, results in rows if "GLIDAR" in results]
    return 1 if "DIFFERENT" in alone or any(isinstance(result, str) or result[0] > 0 for result in ours) else 0


if __name__ == "__main__":
    sys.exit(main())
