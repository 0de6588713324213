#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""GLIDAR in the loop with MuJoCo and ICP: examples/mujoco_rendezvous.py, shortened."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "examples"))
sys.path.insert(0, str(ROOT / "tests" / "support"))

from skipping import importing

with importing():
    import matplotlib  # noqa: F401
    import mujoco
    import numpy as np
    import small_gicp  # noqa: F401
    import zmq  # noqa: F401

import mujoco_rendezvous as example
from mujoco_links import Body, Lockstep, Woods2016Protocol, Trouble, rotation
from waiting import MAX_WAIT_S

EXAMPLE = ROOT / "examples" / "mujoco_rendezvous.py"
SECONDS = 4.0

# A pixel of flash-256 is 1.4 mrad, 60 mm at 45 m. A pose that is wrong by half a pixel, a frame or an axis is off by
# 30 mm or 1.6 degrees; the estimator itself stays below 3 mm and 0.25 degrees over the whole approach (docs/studies.md).
LARGEST_MM, LARGEST_DEG = 6.0, 0.5
# Of 0.1 m of noise on about 700 points, 4 mm are left of the range; of the attitude, whose worst axis has a lever of
# half a metre, about a degree. ICP is no optimum: three times and more.
NOISY_MM, NOISY_DEG = 80.0, 6.0
# Lock-step sends float64, the original GLIDAR protocol float32, whose numbers below 64 m are 2^-18 m apart; 1 nm is for the poses'
# own rounding.
FLOAT32_M = 2.0**-19 + 1e-9


def worst(frames):
    return (max(frame.row.translation_mm for frame in frames), max(frame.row.rotation_deg for frame in frames))


class Loop(unittest.TestCase):
    def approach(self, link_type, sensor):
        with link_type(example.SATELLITE, "--sensor", sensor) as link:
            frames = example.approach(link, SECONDS)
        self.assertIsNotNone(link.program.returncode)
        self.assertEqual(len(frames), round(SECONDS / example.PERIOD_S))
        return frames

    def test_both_protocols_give_the_pose_that_mujoco_has(self):
        for link_type in (Lockstep, Woods2016Protocol):
            with self.subTest(link_type.name):
                translation_mm, rotation_deg = worst(self.approach(link_type, "flash-256"))
                self.assertLess(translation_mm, LARGEST_MM)
                self.assertLess(rotation_deg, LARGEST_DEG)

    def test_noise_of_the_sensor_reaches_the_estimator_and_does_not_throw_it_off(self):
        translation_mm, rotation_deg = worst(self.approach(Lockstep, "flash-128"))
        self.assertLess(translation_mm, NOISY_MM)
        self.assertLess(rotation_deg, NOISY_DEG)
        self.assertGreater(translation_mm, LARGEST_MM)

    def test_both_protocols_give_the_same_clouds_for_the_same_poses(self):
        random = np.random.default_rng(7)
        with (Lockstep(example.SATELLITE, "--sensor", "flash-128") as lockstep,
              Woods2016Protocol(example.SATELLITE, "--sensor", "flash-128") as woods2016):
            for number in range(8):
                quaternions = random.normal(size=(2, 4))
                quaternions /= np.linalg.norm(quaternions, axis=1)[:, None]
                position = random.normal(size=3)
                ahead = rotation(quaternions[0]) @ (0.3, -0.2, 40.0)
                bodies = Body(position, quaternions[0]), Body(position + ahead, quaternions[1])
                one, other = (link.measure(10**9 * number, *bodies) for link in (lockstep, woods2016))
                self.assertGreater(len(one), 100)
                np.testing.assert_allclose(other, one, rtol=0, atol=FLOAT32_M)


class TorqueFreeRotation(unittest.TestCase):
    def test_of_mujoco_is_that_of_glidar(self):
        physics = example.Physics()
        inertia = physics.model.body("target").inertia
        start = physics.body("target")
        keys = {"moments_kg_m2": inertia, "rate_rad_s": example.TARGET_RATE_RAD_S}
        motion = ", ".join(f"{key}: {[float(value) for value in values]}" for key, values in keys.items())
        w, x, y, z = map(float, start.quaternion)
        scene = (f"models: [{{model: 'builtin:box', pose: {{position: [0, 0, 0], orientation: {{w: {w!r}, x: {x!r}, "
                 f"y: {y!r}, z: {z!r}}}}}, motion: {{tumbling: {{{motion}}}}}}}]\n")
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "scene.yaml").write_text(scene, encoding="utf-8")
            subprocess.run(["glidar", "render", "scene.yaml", "--eye", "9,0,0", "--target", "0,0,0", "--width", "8", "--height",
                            "8", "--rate", "1", "--duration", "60", "--columns", "object_pose", "--quiet", "-o", "o.npz"],
                           cwd=folder, check=True, env=dict(os.environ, XDG_CACHE_HOME=folder))
            for second in range(60):
                poses = np.load(Path(folder, f"o_{second:06}.npz"))["object_pose"].reshape(-1, 7)
                expected = poses[np.isfinite(poses).all(axis=1)][0, 3:]
                found = physics.body("target").quaternion
                # RK4 in steps of 5 ms errs by (rate step)^5 = 2e-16 a step, 2e-12 in a minute; rounding adds as much
                self.assertLess(min(np.abs(found - expected).max(), np.abs(found + expected).max()), 1e-10, second)
                physics.step(1.0)


class Program(unittest.TestCase):
    def run_example(self, *arguments, **environment):
        return subprocess.run([sys.executable, str(EXAMPLE), *arguments], capture_output=True, text=True, timeout=MAX_WAIT_S,
                              check=False, env=dict(os.environ, **environment))

    def test_writes_its_table_and_its_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            table, picture = Path(folder, "e.csv"), Path(folder, "p.png")
            done = self.run_example("--seconds", "1", "--table", str(table), "--picture", str(picture))
            self.assertEqual(done.returncode, 0, done.stderr)
            lines = table.read_text(encoding="utf-8").splitlines()
            self.assertEqual(len(lines), 1 + 2 * round(1 / example.PERIOD_S))
            self.assertTrue(lines[-1].startswith("flash-256,woods2016,0.8,45."), lines[-1])
            self.assertEqual(picture.read_bytes()[:4], b"\x89PNG")
        self.assertEqual(done.stdout.count("median"), 2)

    def test_tells_what_is_missing(self):
        done = self.run_example("--seconds", "1", PATH="/nowhere")
        self.assertEqual(done.returncode, 1)
        self.assertIn("glidar is not in PATH", done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "mujoco.py").write_text("raise ImportError(\"No module named 'mujoco'\")\n", encoding="utf-8")
            done = self.run_example(PYTHONPATH=folder)
        self.assertEqual(done.returncode, 1)
        self.assertIn("No module named 'mujoco'; install", done.stderr)

    def test_tells_what_glidar_said(self):
        done = self.run_example("--seconds", "1", "--sensor", "nonsense")
        self.assertEqual(done.returncode, 1)
        self.assertIn("nonsense", done.stderr)
        self.assertIn("glidar did not start", done.stderr)

    def test_has_help_with_examples(self):
        done = self.run_example("--help")
        self.assertEqual(done.returncode, 0)
        self.assertIn("examples/mujoco_rendezvous.py --seconds 20", done.stdout)

    def test_ends_glidar_when_it_is_ended(self):
        program = subprocess.Popen([sys.executable, str(EXAMPLE), "--seconds", "1000"], stdout=subprocess.PIPE, text=True)
        for _ in range(3):
            program.stdout.readline()
        children = Path(f"/proc/{program.pid}/task/{program.pid}/children").read_text(encoding="utf-8").split()
        program.terminate()
        program.communicate(timeout=MAX_WAIT_S)
        self.assertEqual(program.returncode, 143)
        self.assertEqual(len(children), 1)
        self.assertFalse(Path("/proc", children[0]).exists())

    def test_ends_glidar_when_something_goes_wrong(self):
        with self.assertRaises(Trouble), Lockstep(example.SATELLITE, "--sensor", "flash-128") as link:
            link.measure(0, Body(np.zeros(3), np.zeros(4)), Body(np.zeros(3), np.array([1.0, 0, 0, 0])))
        self.assertIsNotNone(link.program.returncode)


if __name__ == "__main__":
    unittest.main()
