#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""How far off may ICP start, and how good is what it finds?

A depth camera sees a target from a new place in every trial. Registration by small_gicp and Open3D finds the camera's
pose against points of the target's model, from starts that are turned and shifted by the steps of a grid, once with
the exact cloud and once with a noisy one. The errors are compared with the Cramer-Rao bound that GLIDAR computes for the
very same view, and beside the estimate that knows every point's plane, which attains it (docs/studies.md).
"""

import argparse
import csv
import multiprocessing
import os
import sys
import time
from dataclasses import astuple, dataclass, fields
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"  # workers are processes, and sums of threads would depend on their order
try:
    import numpy as np
    import open3d
    import small_gicp
    from scipy.spatial import cKDTree

    import glidar
except ImportError as missing:
    sys.exit(f"{missing}; install GLIDAR (docs/python.md) and what scripts/requirements.txt names: "
             "pip install . -r scripts/requirements.txt")
from study_tools import Progress, axis_angle, displaced, surface_points, wilson_percent

open3d.utility.set_max_threads(1)  # for reproducible results
SATELLITE = str(Path(__file__).resolve().parent.parent / "models" / "satellite" / "satellite.obj")
TARGETS = {"asteroid": "builtin:asteroid", "satellite": SATELLITE}
# Starts: turned so far about the target's middle, and shifted by so many of its radii.
ROTATIONS_DEG = (2, 10, 20, 30, 45, 60)
SHIFTS = (0.02, 0.1, 0.2, 0.3, 0.45, 0.6)
SIGMA = 0.003  # of ranges, in radii
CONVERGED = 0.02  # root mean square displacement of the target's points, in radii, that is still the right place
# First some points of the model and partners within a wide reach (in radii), then many and a narrow one; at most so
# many steps.
STAGES = ((10_000, 0.3, 30), (150_000, 0.03, 10))
PIXELS, FOV_DEG = 48, 40.0
COLUMNS = ("xyz", "true_xyz", "normal")
CAUSES = ("fits as well", "local minimum", "out of reach")  # of failure
EXAMPLE = """examples:
  examples/icp_monte_carlo.py                        # 108 views of each target
  examples/icp_monte_carlo.py --trials 432 --picture icp.png --table icp.csv
  examples/icp_monte_carlo.py --target asteroid --trials 72 --seed 7 --workers 1"""


@dataclass
class Row:
    """A registration's line of the table."""

    target: str
    trial: int
    rotation_deg: float  # of the start
    shift: float  # of the start, in radii
    cloud: str
    method: str
    error_m: float  # root mean square displacement of the target's points
    bound_m: float  # the least that its standard deviation can be
    plain_m: float  # the same for least squares that give all points the same weight
    nees: float  # e^T F e: 6 on average for the best estimate
    outcome: str


class Model:
    """Points of a model as each program takes them, and how far partners may be from each other."""

    def __init__(self, points, normals, reach_m, steps):
        self.points, self.normals, self.reach_m, self.steps = points, normals, reach_m, steps
        self.tree = cKDTree(points)
        self.small = small_gicp.PointCloud(points)
        small_gicp.estimate_normals_covariances(self.small)  # from neighbours: it takes no normals from Python
        self.small_tree = small_gicp.KdTree(self.small)
        self.open3d = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
        self.open3d.normals = open3d.utility.Vector3dVector(normals)


class Target:
    """What is seen: how, and what registration knows of it."""

    def __init__(self, name, seed):
        self.name = name
        self.scene = glidar.Scene(TARGETS[name])
        mesh = self.scene.objects[0].mesh
        samples = [surface_points(mesh.vertices, mesh.triangles, count, seed) for count, _, _ in STAGES]
        self.points = samples[0][0]
        self.middle = self.points.mean(axis=0)
        off = self.points - self.middle
        self.radius = np.sqrt((off**2).sum(axis=1).mean())
        self.models = [Model(*sample, reach * self.radius, steps)
                       for sample, (_, reach, steps) in zip(samples, STAGES, strict=True)]
        self.sigma_m = SIGMA * self.radius
        noise = [{"type": "range_gaussian", "sigma_m": self.sigma_m}]
        sensor = glidar.camera(PIXELS, PIXELS, fov_deg=FOV_DEG, noise=noise)
        self.simulator = glidar.Simulator(self.scene, sensor, threads=1)
        # Mean squared displacement of the points by a rotation r about their middle: r^T (mean of |p|^2 1 - p p^T) r.
        self.spread = np.zeros((6, 6))
        self.spread[:3, :3] = (off**2).sum(axis=1).mean() * np.eye(3) - off.T @ off / len(off)
        self.spread[3:, 3:] = np.eye(3)

    def error_m(self, motion):
        return np.sqrt(((self.points @ (motion[:3, :3] - np.eye(3)).T + motion[:3, 3]) ** 2).sum(axis=1).mean())


def by_small_gicp(kind):
    def find(models, points, pose):
        cloud = small_gicp.PointCloud(points)
        if kind == "GICP":
            small_gicp.estimate_covariances(cloud)
        for model in models:
            pose = small_gicp.align(model.small, cloud, model.small_tree, pose, kind, model.reach_m,
                                    max_iterations=model.steps, rotation_epsilon=1e-5,
                                    translation_epsilon=1e-5).T_target_source
        return pose
    return find


def by_open3d(estimation):
    registration = open3d.pipelines.registration

    def find(models, points, pose):
        cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
        for model in models:
            criteria = registration.ICPConvergenceCriteria(1e-6, 1e-6, model.steps)
            pose = registration.registration_icp(cloud, model.open3d, model.reach_m, pose,
                                                 getattr(registration, estimation)(), criteria).transformation
        return pose
    return find


METHODS = {
    "small_gicp plane": by_small_gicp("PLANE_ICP"),
    "small_gicp GICP": by_small_gicp("GICP"),
    "Open3D plane": by_open3d("TransformationEstimationPointToPlane"),
}
WEIGHTED, REFERENCE = "weighted", "planes known"


def weighted(model, points, pose):
    """A pose made better: residuals along the beams, each with the weight that its incidence gives it."""
    middle = model.points.mean(axis=0)
    for _ in range(5):
        there = points @ pose[:3, :3].T + pose[:3, 3]
        beams = (there - pose[:3, 3]) / np.linalg.norm(points, axis=1)[:, None]
        distances, at = model.tree.query(there, distance_upper_bound=model.reach_m)
        near = np.isfinite(distances)
        if near.sum() < 6:
            break
        there, normals = there[near], model.normals[at[near]]
        cosines = (normals * beams[near]).sum(axis=1)
        residuals = ((there - model.points[at[near]]) * normals).sum(axis=1) / cosines
        use = (cosines < -0.1) & (np.abs(residuals) < 4 * np.median(np.abs(residuals)) + 1e-9)
        rows = np.hstack([np.cross(there - middle, normals), normals])[use] / cosines[use, None]
        step, *_ = np.linalg.lstsq(rows, -residuals[use], rcond=None)
        pose = displaced(step[:3], step[3:], middle) @ pose
    return pose


def view(random, target):
    """world_from_sensor: from anywhere around, the target's box well in the picture or not, any side up."""
    def direction():
        them = random.normal(size=3)
        return them / np.linalg.norm(them)

    eye = target.middle + random.uniform(2.5, 4.0) * target.radius * direction()
    return glidar.look_at(eye, target.middle + 0.2 * target.radius * direction(), direction())


class View:
    """The data of a frame relative to the target's centre: clouds, planes, and their Fisher information."""

    def __init__(self, target, frame):
        self.target, self.pose = target, frame.world_from_sensor
        cloud = frame.cloud(COLUMNS, drop_invalid=True)
        self.clouds = {"exact": cloud["true_xyz"], "noisy": cloud["xyz"]}
        self.normals = cloud["normal"].astype(float)
        away = self.clouds["exact"]
        self.cosines = (self.normals * away).sum(axis=1) / np.linalg.norm(away, axis=1)
        self.world_from_middle = displaced(np.zeros(3), target.middle)
        information = frame.fisher_information(reference=np.linalg.inv(self.pose) @ self.world_from_middle)
        self.fisher = information.matrix
        self.bound_m = np.sqrt(np.trace(target.spread @ np.linalg.inv(self.fisher)))
        rows = self.plane_rows()
        inverse = np.linalg.inv(rows.T @ rows)
        weighted = rows * (target.sigma_m * self.cosines[:, None])
        self.plain_m = np.sqrt(np.trace(target.spread @ inverse @ weighted.T @ weighted @ inverse))

    def plane_rows(self):
        """[(p x n)^T, n^T] of every point (Low 2004, equation 9), about the middle, along the world's axes."""
        points = self.clouds["exact"] @ self.pose[:3, :3].T + self.pose[:3, 3] - self.target.middle
        normals = self.normals @ self.pose[:3, :3].T
        return np.hstack([np.cross(points, normals), normals])

    def with_planes_known(self):
        """One step of weighted least squares that knows the plane under every point: the bound's own estimate."""
        off_m = ((self.clouds["noisy"] - self.clouds["exact"]) * self.normals).sum(axis=1)
        weights = 1 / (self.target.sigma_m * self.cosines) ** 2
        weights[np.abs(self.cosines) < 0.01] = 0  # GLIDAR's information leaves these out too
        step = -np.linalg.solve(self.fisher, self.plane_rows().T @ (weights * off_m))
        return self.displacement_pose(step) @ self.pose

    def displacement_pose(self, step):
        return displaced(step[:3], step[3:], self.target.middle)

    def error(self, found):
        """The transform between `found` and the ground truth, and its six parameters."""
        motion = found @ np.linalg.inv(self.pose)
        shift = motion[:3, :3] @ self.target.middle + motion[:3, 3] - self.target.middle
        return motion, np.concatenate([axis_angle(motion[:3, :3]), shift])


def outcome(target, points, pose, found, error_m):
    """The reason for a failure, from the fit of the cloud to the model: as good as with the true pose, worse, or none."""
    if error_m < CONVERGED * target.radius:
        return "converged"

    def misfit_m(place):
        there, model = points @ place[:3, :3].T + place[:3, 3], target.models[0]
        distances, at = model.tree.query(there)
        off = ((there - model.points[at]) * model.normals[at]).sum(axis=1)
        return np.sqrt((off**2).mean()), (distances < model.reach_m).mean()

    found_m, partners = misfit_m(found)
    if partners < 0.5:
        return "out of reach"
    if found_m < 1.5 * max(misfit_m(pose)[0], target.sigma_m):
        return "fits as well"
    return "local minimum"


def run_trial(target, seed, number):
    """All registrations of one view; a function of its arguments alone."""
    random = np.random.default_rng([seed, number])
    frame = target.simulator.simulate(view(random, target), seed=seed, frame=number, columns=COLUMNS)
    seen = View(target, frame)
    cell = number % (len(ROTATIONS_DEG) * len(SHIFTS))
    rotation_deg, shift = ROTATIONS_DEG[cell // len(SHIFTS)], SHIFTS[cell % len(SHIFTS)]
    axis, along = (them / np.linalg.norm(them) for them in random.normal(size=(2, 3)))
    start = displaced(np.radians(rotation_deg) * axis, shift * target.radius * along, target.middle) @ seen.pose
    rows, seconds = [], dict.fromkeys(METHODS, 0.0)

    def add(cloud, method, found):
        motion, error = seen.error(found)
        error_m = target.error_m(motion)
        nees = error @ seen.fisher @ error
        reason = outcome(target, seen.clouds[cloud], seen.pose, found, error_m)
        rows.append(Row(target.name, number, rotation_deg, shift, cloud, method, error_m, seen.bound_m, seen.plain_m,
                        nees, reason))

    for cloud, points in seen.clouds.items():
        for method, find in METHODS.items():
            begun = time.perf_counter()
            found = np.array(find(target.models, points, start))
            seconds[method] += time.perf_counter() - begun
            add(cloud, method, found)
        add(cloud, WEIGHTED, weighted(target.models[-1], points, found))  # from what the last of them found
    add("noisy", REFERENCE, seen.with_planes_known())
    return rows, seconds


_work = {}


def prepare(name, seed):
    _work["target"], _work["seed"] = Target(name, seed), seed


def run_prepared(number):
    return run_trial(_work["target"], _work["seed"], number)


def monte_carlo(name, trials, seed, workers):
    """Rows of all trials, in their order whoever ran them, and the methods' mean seconds."""
    rows, totals = [], dict.fromkeys(METHODS, 0.0)
    with (multiprocessing.get_context("spawn").Pool(workers, prepare, (name, seed)) as pool,
          Progress(name, trials) as progress):
        for made, seconds in pool.imap(run_prepared, range(trials), chunksize=4):
            rows += made
            totals = {method: totals[method] + seconds[method] for method in METHODS}
            progress.step()
    return rows, {method: total / (2 * trials) for method, total in totals.items()}


def chosen(rows, **keys):
    return [row for row in rows if all(getattr(row, key) == value for key, value in keys.items())]


def summary(rows, seconds):
    """For people: how many converge (and the 95 % interval), how good those are, why the others are not."""
    lines = [f"{'method':<17} cloud  {'converged':<22} | median error/bound  e'Fe/6 | {'  '.join(CAUSES)}   ms"]
    for method in [*METHODS, WEIGHTED, REFERENCE]:
        for cloud in ("exact", "noisy"):
            of = chosen(rows, method=method, cloud=cloud)
            if not of:
                continue
            good = chosen(of, outcome="converged")
            ratio = np.median([row.error_m / row.bound_m for row in good]) if good else np.nan
            nees = np.median([row.nees for row in good]) / 5.348 if good else np.nan  # chi-squared's median, 6 dof
            shares = [100 * len(chosen(of, outcome=cause)) / len(of) for cause in CAUSES]
            took = f"{1e3 * seconds[method]:4.0f}" if method in seconds else "   -"
            low, high = wilson_percent(len(good), len(of))
            share = f"{100 * len(good) / len(of):5.1f} % ({low:.1f} to {high:.1f})"
            lines.append(f"{method:<17} {cloud}  {share:<22} | {ratio:18.3f} {nees:7.2f} | "
                         f"{shares[0]:10.1f} % {shares[1]:12.1f} % {shares[2]:11.1f} %  {took}")
    return "\n".join(lines)


def flags_of(arguments):
    parser = argparse.ArgumentParser(description=__doc__, epilog=EXAMPLE,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trials", type=int, default=108, help="views of each target; 36 starts take turns [108]")
    parser.add_argument("--target", action="append", choices=TARGETS, help="repeatable [all]")
    parser.add_argument("--seed", type=int, default=1, help="of all random numbers [1]")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="processes; results do not depend on it")
    parser.add_argument("--table", metavar="FILE", help="writes every registration as CSV")
    parser.add_argument("--picture", metavar="FILE", help="draws maps and errors, for example as PNG")
    flags = parser.parse_args(arguments)
    if flags.trials < 1 or flags.workers < 1 or flags.seed < 0:
        parser.error("--trials and --workers: at least 1; --seed: at least 0")
    return flags


def main(arguments=None):
    flags = flags_of(arguments)
    if flags.picture:
        from icp_pictures import draw  # needs matplotlib
    everything = []
    for name in flags.target or TARGETS:
        rows, seconds = monte_carlo(name, flags.trials, flags.seed, flags.workers)
        print(f"{name}: {flags.trials} views\n{summary(rows, seconds)}\n", flush=True)
        everything += rows
    if flags.table:
        with open(flags.table, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow([field.name for field in fields(Row)])
            writer.writerows(map(astuple, everything))
    if flags.picture:
        draw(everything, flags.picture)


if __name__ == "__main__":
    try:
        main()
    except (glidar.Error, OSError, ImportError) as trouble:
        sys.exit(f"icp_monte_carlo: {trouble}")
    except KeyboardInterrupt:
        sys.exit(130)
