#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The C++ client of docs/link/lockstep.md with glidar stream --lockstep."""

import os
import subprocess
import unittest
from pathlib import Path

import lockstep_test as lockstep
import numpy as np
from cli_support import MAX_WAIT_S, CliTest
from skipping import IN_CTEST, skip

PROGRAM = os.environ.get("GLIDAR_LOCKSTEP_CLIENT", "")
SOURCE = Path(__file__).resolve().parents[2] / "examples" / "lockstep_client.cpp"


class Client(CliTest):
    def run_client(self, endpoint):
        return subprocess.run([PROGRAM, endpoint], capture_output=True, text=True, timeout=MAX_WAIT_S, check=False)

    def test_is_named_in_the_docs(self):
        self.assertTrue(SOURCE.is_file())
        self.assertIn(f"(../../examples/{SOURCE.name})", lockstep.DOCS)

    def test_gets_the_same_clouds_as_the_python_client(self):
        with lockstep.Server(self, "builtin:asteroid") as server:
            done = self.run_client(server.endpoint)
            turning = lockstep.body((0, 0, 0), rate=(0, 0, 0.1))
            _, cloud = lockstep.ask(server.connect(), ["xyz"], [(0, 1, 0, [lockstep.SENSOR, turning])])[0]
        hits = cloud["xyz"].reshape(-1, 3)
        hits = hits[np.isfinite(hits[:, 0])]
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout, f"{len(hits)} points, the nearest {hits[:, 2].min():.3f} m ahead\n")
        self.assertGreater(len(hits), 1000)

    def test_reports_errors_as_text(self):
        with open(os.path.join(self.folder, "two.yaml"), "w", encoding="utf-8") as scene:
            scene.write("models: [{model: builtin:box}, {model: builtin:box}]\n")
        with lockstep.Server(self, "two.yaml") as server:
            done = self.run_client(server.endpoint)
        self.assertEqual(done.returncode, 1)
        self.assertIn("number of objects", done.stdout)


if __name__ == "__main__":
    if not PROGRAM:
        skip("GLIDAR_LOCKSTEP_CLIENT is not set", IN_CTEST)
    unittest.main()
