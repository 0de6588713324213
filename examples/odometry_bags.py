#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""LiDAR odometry from ROS bags, with and without the time of each point.

The drive of lidar_odometry.py is written to two bags, whose clouds have the fields of the Velodyne driver, or no ring and
time. KISS-ICP reads them with its own reader of bags. It deskews clouds that have times. Errors are relative to the true
trajectory.
"""

import argparse
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
    from kiss_icp.config import KISSConfig
    from kiss_icp.config.config import MappingConfig
    from kiss_icp.datasets.rosbag import RosbagDataset
    from kiss_icp.kiss_icp import KissICP

    import glidar
except ImportError as missing:
    sys.exit(f"{missing}; install GLIDAR (docs/python.md) and what scripts/requirements.txt names: "
             "pip install . -r scripts/requirements.txt")
from lidar_odometry import evaluated, route, street
from study_tools import Progress

TOPIC = "/lidar/points"
EXAMPLE = """examples:
  examples/odometry_bags.py                             # 20 s through the street with a VLP-16
  examples/odometry_bags.py --sensor OS1-32 --seconds 8 --format .mcap
  examples/odometry_bags.py --keep bags                 # the bags, for other programs
  examples/odometry_bags.py --picture odometry.png      # the trajectories"""

# What the clouds contain, and the phase of the revolution to which a pose belongs: KISS-ICP deskews to the end of the
# revolution; what is not deskewed is seen, on average, from where the sensor is half-way.
BAGS = {
    "with_times": ({"layout": "velodyne"}, 1.0),
    "without_times": ({"columns": ["xyz", "intensity"]}, 0.5),
}


def frames(scene, sensor, trajectory, seconds, seed):
    """The frames of all revolutions, one after the other."""
    revolutions = round(seconds * sensor.rate_hz)
    simulator = glidar.Simulator(scene, sensor)
    with Progress("driving", revolutions) as progress:
        for number in range(revolutions):
            yield simulator.simulate(trajectory, seed=seed, frame=number, columns=["xyz", "intensity", "ring", "time"])
            progress.step()


def odometry(name, bag, trajectory, rate_hz):
    """Runs KISS-ICP over all clouds of a bag."""
    config = KISSConfig(mapping=MappingConfig(voxel_size=1.0))
    config.data.max_range, config.data.min_range, config.data.deskew = 100.0, 1.0, True
    config.registration.max_num_threads = 1  # sums of threads would depend on their order
    estimator, poses, dataset = KissICP(config), [], RosbagDataset(bag, TOPIC)
    with Progress(name, len(dataset)) as progress:
        for number in range(len(dataset)):
            points, times = dataset[number]
            estimator.register_frame(points, times)
            poses.append(estimator.last_pose.copy())
            progress.step()
    stamps_s = np.array(dataset.get_frames_timestamps())
    phase = BAGS[name][1]
    return evaluated(name, np.stack(poses), trajectory, stamps_s + phase / rate_hz, round(rate_hz))


def run(flags, folder):
    """The errors of the odometry on both bags, which are written to a folder."""
    sensor, times = glidar.load_sensor(flags.sensor), np.arange(0, flags.seconds + 0.5, 0.002)
    trajectory = glidar.Trajectory.timed(times, route(times))
    scene, runs = street(flags.street), []
    for name, (fields, _) in BAGS.items():
        bag = Path(folder) / f"{name}{flags.format}"
        with glidar.open_output(bag, sensor, **fields) as output:
            for frame in frames(scene, sensor, trajectory, flags.seconds, flags.seed):
                output.write(frame)
        runs.append(odometry(name, bag, trajectory, sensor.rate_hz))
    return runs


def flags_of(arguments):
    parser = argparse.ArgumentParser(description=__doc__, epilog=EXAMPLE,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=20, help="of the drive [20]")
    parser.add_argument("--sensor", default="VLP-16", help="a spinning sensor [VLP-16]")
    parser.add_argument("--street", type=int, default=3, help="seed of the objects beside the road [3]")
    parser.add_argument("--seed", type=int, default=1, help="of the sensor's noise [1]")
    parser.add_argument("--format", choices=[".rosbag2", ".mcap"], default=".rosbag2", help="of the bags [.rosbag2]")
    parser.add_argument("--keep", metavar="FOLDER", help="existing folder for the bags [a temporary one]")
    parser.add_argument("--picture", metavar="FILE", help="draws the trajectories and errors, for example as PNG")
    flags = parser.parse_args(arguments)
    if not 2 <= flags.seconds <= 60:
        parser.error("--seconds: from 2 to 60")
    return flags


def main(arguments=None):
    flags = flags_of(arguments)
    if flags.picture:
        from odometry_pictures import draw_runs  # needs matplotlib
    with tempfile.TemporaryDirectory() as folder:
        runs = run(flags, flags.keep or folder)
    print(f"{len(runs[0].poses)} clouds; ATE after alignment, RPE over a second\n"
          f"{'':<14}  ATE m  largest m  RPE % of way  RPE deg/m")
    for found in runs:
        print(f"{found.name:<14} {found.ate_m():6.3f} {found.errors_m.max():10.3f} {found.drift_percent:13.3f} "
              f"{found.turn_deg_m:10.4f}")
    if flags.picture:
        draw_runs(runs, flags.picture)


if __name__ == "__main__":
    try:
        main()
    except (glidar.Error, OSError, ImportError) as trouble:
        sys.exit(f"odometry_bags: {trouble}")
    except KeyboardInterrupt:
        sys.exit(130)
