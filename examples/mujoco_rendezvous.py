#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""GLIDAR in the loop with a physics simulator and a pose estimator.

MuJoCo moves a tumbling satellite, on which no torque acts, and a chaser with a flash LiDAR. GLIDAR measures what the
LiDAR sees, ICP (small_gicp) finds the satellite's pose in every cloud, and the chaser steers by that pose alone. All
of it runs twice: in lock-step and by the original GLIDAR protocol (docs/studies.md).
"""

import argparse
import signal
import sys
from dataclasses import dataclass
from pathlib import Path

try:
    import mujoco
    import numpy as np
    import small_gicp
    from mujoco_links import Body, Lockstep, Woods2016Protocol, Trouble, rotation
except ImportError as missing:
    sys.exit(f"{missing}; install what scripts/requirements.txt names: pip install -r scripts/requirements.txt")

SATELLITE = Path(__file__).resolve().parent.parent / "models" / "satellite" / "satellite.obj"
PERIOD_S = 0.2  # of frames
CHASER_KG, CHASER_KG_M2 = 120.0, 15.0
EXAMPLE = """examples:
  examples/mujoco_rendezvous.py                              # both protocols, a table of the errors
  examples/mujoco_rendezvous.py --seconds 20 --protocol lockstep --table errors.csv
  examples/mujoco_rendezvous.py --picture rendezvous.png     # needs matplotlib"""

# Bodies' frames: the satellite's is its model's; the chaser's is the LiDAR's, x right, y down, z forward. The wings
# make the satellite's moment about y the least.
WORLD = f"""
<mujoco>
  <option gravity="0 0 0" timestep="0.005" integrator="RK4"/>
  <worldbody>
    <body name="target" quat="0.8 0.3 0.2 0.45">
      <freejoint/>
      <inertial pos="0 0 0" mass="400" diaginertia="900 220 1000"/>
    </body>
    <body name="chaser" pos="45 3 -2" quat="0.5 -0.5 -0.5 0.5">
      <freejoint/>
      <inertial pos="0 0 0" mass="{CHASER_KG}" diaginertia="{CHASER_KG_M2} {CHASER_KG_M2} {CHASER_KG_M2}"/>
    </body>
  </worldbody>
</mujoco>"""
TARGET_RATE_RAD_S = (0.02, 0.03, 0.14)  # about its own axes
FROM_M, TO_M, APPROACH_S = 45.0, 22.0, 54.0  # distances at which the approach begins and ends, and how long it takes


class Physics:
    """MuJoCo's world: the target tumbles, the chaser is pushed and turned."""

    def __init__(self):
        self.model = mujoco.MjModel.from_xml_string(WORLD)
        self.data = mujoco.MjData(self.model)
        self.data.joint(0).qvel[3:] = TARGET_RATE_RAD_S
        mujoco.mj_forward(self.model, self.data)

    def body(self, name):
        joint = self.data.joint(self.model.body(name).jntadr[0])
        quaternion = joint.qpos[3:].copy()  # a free joint turns along the body's axes
        return Body(joint.qpos[:3].copy(), quaternion, rotation(quaternion) @ joint.qvel[3:], joint.qvel[:3].copy())

    def step(self, seconds, force=(0, 0, 0), torque=(0, 0, 0)):
        """Force and torque act on the chaser, along its axes."""
        axes = rotation(self.body("chaser").quaternion)
        self.data.body("chaser").xfrc_applied[:] = np.concatenate([axes @ force, axes @ torque])
        for _ in range(round(seconds / self.model.opt.timestep)):
            mujoco.mj_step(self.model, self.data)


def surface_points(path, count, seed=1):
    """Points spread evenly over the triangles of an OBJ file, read here and not by GLIDAR."""
    vertices, triangles = [], []
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            triangles += [(corners[0], *corners[k:k + 2]) for k in range(1, len(corners) - 1)]
    a, b, c = np.array(vertices)[np.array(triangles)].transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    random = np.random.default_rng(seed)
    at = random.choice(len(areas), count, p=areas / areas.sum())
    u, v = random.random((2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return a[at] + u * (b - a)[at] + v * (c - a)[at]


class Tracker:
    """Finds the target in one cloud after the other, from where it should have gone since."""

    def __init__(self, first_guess):
        points = surface_points(SATELLITE, 800_000)
        # First a coarse model, whose panels are too thin to be taken for their other side, then a fine one.
        coarse, fine = (small_gicp.preprocess_points(points, cell_m, num_neighbors=20) for cell_m in (0.1, 0.015))
        self.models = (coarse, fine, fine)
        self.guess, self.last = first_guess, None  # target_from_sensor

    def find(self, points):
        """sensor_from_target."""
        cloud, _ = small_gicp.preprocess_points(points, 0.04)
        found, reach_m = self.guess, 0.5
        for model, tree in self.models:
            result = small_gicp.align(model, cloud, tree, found, "PLANE_ICP", reach_m, max_iterations=50,
                                      rotation_epsilon=1e-5, translation_epsilon=1e-5)
            found = result.T_target_source
            rms_m = np.sqrt(2 * result.error / max(result.num_inliers, 1))
            reach_m = np.clip(4 * rms_m, 0.05, 0.5)  # farther from the surface is what belongs to another one
        self.guess = found if self.last is None else found @ np.linalg.inv(self.last) @ found
        self.last = found
        return np.linalg.inv(found)


class Steering:
    """Keeps the target on the boresight at the distance of the plan, from what ICP found and a gyroscope."""

    def __init__(self):
        self.before = None

    @staticmethod
    def wanted_m(time_s):
        part = min(time_s / APPROACH_S, 1.0)
        return FROM_M + (TO_M - FROM_M) * part * part * (3 - 2 * part)

    def thrust(self, time_s, target, rate):
        """(force, torque) along the chaser's axes; `rate` is about the same axes."""
        away = target - [0, 0, self.wanted_m(time_s)]
        speed = np.zeros(3) if self.before is None else (away - self.before) / PERIOD_S
        self.before = away
        aim = np.cross([0, 0, 1], target / np.linalg.norm(target))
        return CHASER_KG * (0.25 * away + 1.0 * speed), CHASER_KG_M2 * (1.0 * aim - 1.6 * rate)


@dataclass
class Row:
    """A frame's line of the table."""

    time_s: float
    range_m: float
    points: int
    translation_mm: float
    rotation_deg: float


@dataclass
class Snapshot:
    """A frame for the picture."""

    row: Row
    points: np.ndarray
    found: np.ndarray  # sensor_from_target


def pose_errors(found, truth):
    """(millimetres, degrees) between two poses."""
    turn = found[:3, :3] @ truth[:3, :3].T
    sine = np.linalg.norm([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]) / 2
    angle = np.degrees(np.arctan2(sine, (np.trace(turn) - 1) / 2))
    return 1e3 * np.linalg.norm(found[:3, 3] - truth[:3, 3]), angle


def first_guess(target_from_sensor):
    """What a chaser would know when it begins: 10 cm and 3 degrees off."""
    off = np.eye(4)
    off[:3, :3] = rotation(np.concatenate([[np.cos(0.026)], np.sin(0.026) * np.ones(3) / np.sqrt(3)]))
    off[:3, 3] = 0.058
    return off @ target_from_sensor


def approach(link, seconds, tell=None):
    """Runs physics, sensor and estimator in a ring; a snapshot of every frame."""
    physics, steering, tracker, frames = Physics(), Steering(), None, []
    for number in range(round(seconds / PERIOD_S)):
        sensor, target = physics.body("chaser"), physics.body("target")
        truth = np.linalg.inv(sensor.pose()) @ target.pose()
        points = link.measure(round(1e9 * PERIOD_S) * number, sensor, target)
        tracker = tracker or Tracker(first_guess(np.linalg.inv(truth)))
        found = tracker.find(points)
        row = Row(number * PERIOD_S, np.linalg.norm(truth[:3, 3]), len(points), *pose_errors(found, truth))
        frames.append(Snapshot(row, points, found))
        if tell:
            tell(row)
        rate = rotation(sensor.quaternion).T @ sensor.rate
        physics.step(PERIOD_S, *steering.thrust(row.time_s, found[:3, 3], rate))
    return frames


def table(runs):
    """Every frame of every run, as CSV."""
    lines = ["sensor,protocol,time_s,range_m,points,translation_error_mm,rotation_error_deg"]
    for (sensor, protocol), frames in runs.items():
        for row in (frame.row for frame in frames):
            lines.append(f"{sensor},{protocol},{row.time_s:.1f},{row.range_m:.3f},{row.points},"
                         f"{row.translation_mm:.3f},{row.rotation_deg:.4f}")
    return "\n".join(lines) + "\n"


def flags_of(arguments):
    parser = argparse.ArgumentParser(description=__doc__, epilog=EXAMPLE,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=60, help="of the simulation [60]")
    parser.add_argument("--sensor", action="append", help="as glidar sensors lists them, repeatable [flash-256]")
    parser.add_argument("--protocol", choices=["lockstep", "woods2016", "both"], default="both", help="[both]")
    parser.add_argument("--table", metavar="FILE", help="writes the errors of every frame as CSV")
    parser.add_argument("--picture", metavar="FILE", help="draws four frames and the errors, for example as PNG")
    flags = parser.parse_args(arguments)
    if not 1 <= flags.seconds <= 3600:
        parser.error("--seconds: from 1 to 3600")
    return flags


def main(arguments=None):
    flags = flags_of(arguments)
    if flags.picture:
        from mujoco_picture import draw  # needs matplotlib
    links = {"lockstep": [Lockstep], "woods2016": [Woods2016Protocol], "both": [Lockstep, Woods2016Protocol]}[flags.protocol]
    runs, every = {}, max(round(flags.seconds / PERIOD_S) // 10, 1)
    for sensor in flags.sensor or ["flash-256"]:
        for link_type in links:
            print(f"{sensor}, {link_type.name}\n  time s  range m  points  translation mm  rotation deg")
            with link_type(SATELLITE, "--sensor", sensor) as link:
                frames = approach(link, flags.seconds, lambda row: round(row.time_s / PERIOD_S) % every == 0 and print(
                    f"{row.time_s:8.1f} {row.range_m:8.2f} {row.points:7} {row.translation_mm:15.2f} "
                    f"{row.rotation_deg:13.3f}", flush=True))
            errors = np.array([(frame.row.translation_mm, frame.row.rotation_deg) for frame in frames])
            print("  median {:.2f} mm, {:.3f} deg; largest {:.2f} mm, {:.3f} deg".format(
                *np.median(errors, axis=0), *errors.max(axis=0)))
            runs[sensor, link_type.name] = frames
    if flags.table:
        Path(flags.table).write_text(table(runs), encoding="utf-8")
    if flags.picture:
        draw(runs, surface_points(SATELLITE, 30_000), flags.picture)


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # by way of the blocks that end glidar
    try:
        main()
    except (Trouble, OSError, ImportError) as trouble:
        sys.exit(f"mujoco_rendezvous: {trouble}")
    except KeyboardInterrupt:
        sys.exit(130)
