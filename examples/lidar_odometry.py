#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What motion distortion does to LiDAR odometry, and what deskewing saves.

A VLP-16 drives through a street. It turns ten times a second, and every beam sees the street from where the sensor is
when it fires. KISS-ICP finds the trajectory from the scans alone: with its deskewing, which is given every point's time;
without; and from scans that are deskewed with the ground truth. Errors are relative to the true trajectory.
"""

import argparse
import itertools
import sys
from dataclasses import dataclass
from pathlib import Path

try:
    import numpy as np
    from kiss_icp.config import KISSConfig
    from kiss_icp.config.config import MappingConfig
    from kiss_icp.kiss_icp import KissICP

    import glidar
except ImportError as missing:
    sys.exit(f"{missing}; install GLIDAR (docs/python.md) and what scripts/requirements.txt names: "
             "pip install . -r scripts/requirements.txt")
from study_tools import Progress, aligned, position_errors, relative_errors, ways

SPEED_M_S = 9.0
HEIGHT_M = 1.8
EXAMPLE = """examples:
  examples/lidar_odometry.py                            # 20 s through the street with a VLP-16
  examples/lidar_odometry.py --sensor OS1-32 --seconds 8
  examples/lidar_odometry.py --street 4 --seed 2        # another street, other noise
  examples/lidar_odometry.py --picture odometry.png --write odometry    # trajectories (TUM, KITTI) and scans (.bin)"""


def box(size):
    """Vertices and triangles of a box on the ground."""
    signs = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0, 1)])
    faces = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    triangles = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
    return signs * size, triangles


def post(radius_m, height_m, sides=10):
    """Corners and triangles of an upright tube around the origin."""
    angles = 2 * np.pi * np.arange(sides) / sides
    ring = radius_m * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    low, following = np.arange(sides), (np.arange(sides) + 1) % sides
    triangles = np.concatenate([np.stack([low, following, low + sides], axis=1),
                                np.stack([following, following + sides, low + sides], axis=1)])
    return np.concatenate([ring, ring + [0, 0, height_m]]), triangles


def beside(pose, side, away_m, along_m=0.0):
    """A place on the ground beside the road, turned along it."""
    at = pose[:3, 3] + side * away_m * pose[:3, 1] + along_m * pose[:3, 0]
    half = np.arctan2(pose[1, 0], pose[0, 0]) / 2
    return glidar.pose([at[0], at[1], 0.0], wxyz=[np.cos(half), 0, 0, np.sin(half)])


def street(seed=3):
    """Houses, parked cars, trees and street lights along the road of `route`, on flat ground."""
    random, scene = np.random.default_rng(seed), glidar.Scene()
    wall, paint, bark = ({"*": {"diffuse": [grey] * 3}} for grey in (0.5, 0.3, 0.2))
    scene.add_model("builtin:plane", name="ground", scale=150.0, pose=glidar.pose([60, 30, 0]),
                    materials={"*": {"surface": "asphalt"}})
    road, trunk, lamp = route(np.arange(0, 40, 0.02))[:, :2, 3], None, None
    for pose, side in itertools.product(route(np.arange(-1.0, 30.0, 1.1)), (-1, 1)):
        house, car, tree = (beside(pose, side, away_m, along_m) for away_m, along_m in (
            (random.uniform(11, 15), 0.0), (4.0, random.uniform(-3, 3)), (6.0, random.uniform(-3, 3))))
        # Objects on the road, where it returns to the same place, are omitted.
        house_free, car_free, tree_free = (np.linalg.norm(road - place[:2, 3], axis=1).min() > least_m
                                           for place, least_m in ((house, 8.0), (car, 2.8), (tree, 4.0)))
        if house_free:
            scene.add_mesh(*box(random.uniform((5, 6, 4), (9, 8, 10))), name=f"house_{len(scene)}", class_name="house",
                           materials=wall, pose=house)
        if car_free and random.random() < 0.6:
            scene.add_mesh(*box((4.2, 1.8, 1.5)), name=f"car_{len(scene)}", class_name="car", materials=paint, pose=car)
        if tree_free and random.random() < 0.5:
            trunk = copy_of(scene, trunk, post(0.2, 3.0), "trunk", bark, tree)
            scene.add_model("builtin:sphere", name=f"crown_{len(scene)}", class_name="crown", materials=bark,
                            scale=random.uniform(1.0, 1.8), pose=tree @ glidar.pose([0, 0, 3.8]))
        elif tree_free:
            lamp = copy_of(scene, lamp, post(0.1, 6.0), "lamp", bark, tree)
    return scene


def copy_of(scene, first, mesh, name, material, pose):
    """The first of its kind brings the mesh, others share it."""
    if first is not None:
        scene.add_instance(first, name=f"{name}_{len(scene)}", pose=pose)
        return first
    return scene.add_mesh(*mesh, name=f"{name}_{len(scene)}", class_name=name, materials=material, pose=pose)


def route(times_s):
    """world_from_sensor (N, 4, 4): a road with bends both ways, and the sway of a vehicle. Smooth."""
    times_s = np.atleast_1d(times_s)
    fine = np.linspace(-5.0, 65.0, 70_001)
    heading = 0.9 * np.sin(2 * np.pi * fine / 9.0) + 0.045 * fine
    step = SPEED_M_S * (fine[1] - fine[0])
    x, y = (np.interp(times_s, fine, np.cumsum(turn(heading)) * step) for turn in (np.cos, np.sin))
    yaw = np.interp(times_s, fine, heading)
    roll, pitch = 0.02 * np.sin(2 * np.pi * 0.7 * times_s), 0.015 * np.sin(2 * np.pi * 1.1 * times_s)
    z = HEIGHT_M + 0.03 * np.sin(2 * np.pi * 1.3 * times_s)
    return np.stack([pose_of(*numbers) for numbers in zip(x, y, z, yaw, pitch, roll, strict=True)])


def pose_of(x, y, z, yaw, pitch, roll):
    half = np.array([yaw, pitch, roll]) / 2
    (cy, cp, cr), (sy, sp, sr) = np.cos(half), np.sin(half)
    return glidar.pose([x, y, z], wxyz=[cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy,
                                        cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy])


@dataclass
class Scan:
    """A turn of the sensor."""

    xyz: np.ndarray  # in the sensor's frame of each point's own time
    deskewed: np.ndarray  # as measured by a sensor that stays at the pose of the scan's start
    phase: np.ndarray  # of the turn, 0 to 1


def drive(scene, sensor, seconds, seed=1):
    """Scans of every turn, and the trajectory: world_from_sensor as a function of time."""
    times = np.arange(0, seconds + 0.5, 0.002)
    trajectory = glidar.Trajectory.timed(times, route(times))
    turns, scans = round(seconds * sensor.rate_hz), []
    simulator = glidar.Simulator(scene, sensor)
    with Progress("driving", turns) as progress:
        for number in range(turns):
            frame = simulator.simulate(trajectory, seed=seed, frame=number, columns=["xyz", "time", "sensor_pose"])
            cloud = frame.cloud(["xyz", "time"], drop_invalid=True)
            still = frame.cloud(["xyz"], drop_invalid=True, deskew=True)
            scans.append(Scan(cloud["xyz"], still["xyz"], cloud["time"] * 1e-9 * sensor.rate_hz))
            progress.step()
    return scans, trajectory


@dataclass
class Run:
    """What odometry made of the scans."""

    name: str
    poses: np.ndarray  # of the sensor, as found, at `times_s`
    truth: np.ndarray
    times_s: np.ndarray
    errors_m: np.ndarray  # of positions, trajectories being aligned
    drift_percent: float  # of the way, over each second
    turn_deg_m: float  # rotation error per distance

    def ate_m(self):
        return np.sqrt((self.errors_m**2).mean())


# How scans are given, whether KISS-ICP deskews, and the phase of the turn to which a pose belongs: it deskews to the
# turn's end; what is not deskewed is seen, on average, from where the sensor is half-way.
RUNS = {
    "no deskewing": ("xyz", False, 0.5),
    "KISS-ICP's deskewing": ("xyz", True, 1.0),
    "deskewed by the ground truth": ("deskewed", False, 0.0),
}


def odometry(name, scans, trajectory, rate_hz):
    """Runs KISS-ICP over all scans."""
    kind, deskew, phase = RUNS[name]
    config = KISSConfig(mapping=MappingConfig(voxel_size=1.0))
    config.data.max_range, config.data.min_range, config.data.deskew = 100.0, 1.0, deskew
    config.registration.max_num_threads = 1  # sums of threads would depend on their order
    estimator, poses = KissICP(config), []
    with Progress(name, len(scans)) as progress:
        for scan in scans:
            estimator.register_frame(getattr(scan, kind), scan.phase)
            poses.append(estimator.last_pose.copy())
            progress.step()
    return evaluated(name, np.stack(poses), trajectory, (np.arange(len(scans)) + phase) / rate_hz, round(rate_hz))


def evaluated(name, poses, trajectory, times_s, apart):
    truth = trajectory.poses_at(times_s)
    metres, radians = relative_errors(poses, truth, apart)
    way = ways(truth, apart)
    return Run(name, poses, truth, times_s, position_errors(poses, truth), 100 * np.sqrt(((metres / way) ** 2).mean()),
               np.degrees(np.sqrt(((radians / way) ** 2).mean())))


def write(folder, runs, scans):
    """Trajectories in the TUM and KITTI formats, aligned with the ground truth, and scans in KITTI's format."""
    folder.mkdir(parents=True, exist_ok=True)
    for run in runs:
        name = run.name.replace(" ", "_").replace("'", "")
        found = aligned(run.poses[:, :3, 3], run.truth[:, :3, 3]) @ run.poses
        for stem, poses in ((name, found), (f"truth_of_{name}", run.truth)):
            np.savetxt(folder / f"{stem}.kitti", poses[:, :3].reshape(-1, 12), fmt="%.9g")
            quaternions = np.stack([glidar.quaternion(pose, "xyzw") for pose in poses])
            np.savetxt(folder / f"{stem}.tum", np.column_stack([run.times_s, poses[:, :3, 3], quaternions]), fmt="%.9f")
    for number, scan in enumerate(scans):
        np.column_stack([scan.xyz, scan.phase]).astype("<f4").tofile(folder / f"{number:06d}.bin")


def flags_of(arguments):
    parser = argparse.ArgumentParser(description=__doc__, epilog=EXAMPLE,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=20, help="of the drive [20]")
    parser.add_argument("--sensor", default="VLP-16", help="as glidar sensors lists them [VLP-16]")
    parser.add_argument("--street", type=int, default=3, help="seed of the objects beside the road [3]")
    parser.add_argument("--seed", type=int, default=1, help="of the sensor's noise [1]")
    parser.add_argument("--ground-truth", action="store_true", help="the sensor without its noise")
    parser.add_argument("--write", metavar="FOLDER", help="writes trajectories (TUM, KITTI) and scans (KITTI)")
    parser.add_argument("--picture", metavar="FILE", help="draws map, trajectories and errors, for example as PNG")
    flags = parser.parse_args(arguments)
    if not 2 <= flags.seconds <= 60:
        parser.error("--seconds: from 2 to 60")
    if flags.street < 0 or flags.seed < 0:
        parser.error("--street and --seed: at least 0")
    return flags


def main(arguments=None):
    flags = flags_of(arguments)
    if flags.picture:
        from odometry_pictures import draw  # needs matplotlib
    sensor = glidar.load_sensor(flags.sensor)
    if sensor.kind != "spinning":
        sys.exit(f"lidar_odometry: {flags.sensor} is not a spinning sensor; `glidar sensors` lists them, such as VLP-16")
    sensor = sensor.ground_truth() if flags.ground_truth else sensor
    scans, trajectory = drive(street(flags.street), sensor, flags.seconds, flags.seed)
    runs = [odometry(name, scans, trajectory, sensor.rate_hz) for name in RUNS]
    print(f"{len(scans)} scans, {SPEED_M_S * flags.seconds:.0f} m; ATE after alignment, RPE over a second\n"
          f"{'':<22}  ATE m  largest m  RPE % of way  RPE deg/m")
    for run in runs:
        print(f"{run.name:<22} {run.ate_m():6.3f} {run.errors_m.max():10.3f} {run.drift_percent:13.3f} "
              f"{run.turn_deg_m:10.4f}")
    if flags.write:
        write(Path(flags.write), runs, scans)
    if flags.picture:
        draw(runs, scans, flags.picture)


if __name__ == "__main__":
    try:
        main()
    except (glidar.Error, OSError, ImportError) as trouble:
        sys.exit(f"lidar_odometry: {trouble}")
    except KeyboardInterrupt:
        sys.exit(130)
