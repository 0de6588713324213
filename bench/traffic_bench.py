#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What traffic costs: frames of a scanner on a car in a street with 200 parked and 200 driving cars and 50 people who
walk, beside frames of the same street at rest. Both take turns; medians of processor time. --picture draws a
frame."""

import argparse
import statistics
import sys
import time
from pathlib import Path

try:
    import numpy as np

    import glidar
except ImportError as missing:
    sys.exit(f"{missing}; install GLIDAR (docs/python.md) and what scripts/requirements.txt names")

STREET = Path(__file__).resolve().parent.parent / "models" / "street"
EXAMPLE = """example:
  PYTHONPATH=build/release/python build/venv/bin/python bench/traffic_bench.py --picture docs/images/traffic-bench.view.png"""


def road_user(model, x_m, y_m, yaw_deg, speed_m_s):
    user = {"model": str(STREET / f"{model}.obj"), "class": model,
            "pose": {"position": [x_m, y_m, 0], "euler_deg": {"yaw": yaw_deg}}}
    if speed_m_s > 0:
        user["motion"] = {"twist": {"velocity_m_s": [speed_m_s, 0, 0]}}
    return user


def street(moves):
    """The scene; the lanes are 500 m long to both sides of the sensor."""
    models = [{"model": "builtin:box", "class": "road", "scale": [500, 12, 0.05], "pose": {"position": [0, 0, -0.05]}}]
    for i in range(200):
        side = 1 if i % 2 else -1
        yaw_deg = 180 if side > 0 else 0
        x_m = 5.0 * i - 500.0
        models.append(road_user("car", x_m, 5.5 * side, yaw_deg, 0))
        models.append(road_user("car", x_m + 2, 2.0 * side, yaw_deg, 5.0 * moves))
        if i % 4 == 0:
            models.append(road_user("person", x_m, 8.5 * side, yaw_deg, 1.4 * moves))
    return glidar.Scene.from_dict({"models": models})


def drive():
    """The sensor, 2 m above the middle of the road, at 15 m/s."""
    pose = np.eye(4)
    pose[2, 3] = 2.0
    return glidar.Trajectory.twist(pose, linear_m_s=(15, 0, 0))


def measure(sensor, scenes, rounds):
    """The median seconds of a frame of each scene."""
    simulators = {name: glidar.Simulator(scene, glidar.load_sensor(sensor)) for name, scene in scenes.items()}
    seconds = {name: [] for name in scenes}
    trajectory = drive()
    for frame in range(rounds + 2):
        for name, simulator in simulators.items():
            start = time.process_time()
            simulator.simulate(trajectory, frame=frame)
            if frame >= 2:
                seconds[name].append(time.process_time() - start)
    return {name: statistics.median(values) for name, values in seconds.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, epilog=EXAMPLE,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=11, help="frames that are measured [11]")
    parser.add_argument("--picture", metavar="NAME.view.png", help="where to draw a frame")
    flags = parser.parse_args()
    scenes = {"parked": street(0), "traffic": street(1)}
    for sensor in ("VLP-16", "OS1-128"):
        found = measure(sensor, scenes, flags.rounds)
        print(f"{sensor}: parked {1e3 * found['parked']:.1f} ms, traffic {1e3 * found['traffic']:.1f} ms; "
              f"ratio {found['traffic'] / found['parked']:.2f}", flush=True)
    if flags.picture:
        frame = glidar.simulate(scenes["traffic"], "OS1-128", drive())
        frame.save(flags.picture, colour_by="class", picture_size=(1200, 600), view_eye=(-14, -10, 14), view_target=(10, 0, 0))


if __name__ == "__main__":
    main()
