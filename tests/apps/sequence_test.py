# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Sequences of frames from the command line. The built program is found in PATH."""

import os
import unittest

from cli_support import CliTest


class Sequences(CliTest):
    def test_a_duration_gives_numbered_frames_that_join(self):
        self.write("scene.yaml", "models: [{model: builtin:box, scale: 8}]\nsensor: VLP-16\n"
                                 "sensor_pose: {position: [0, 0, 0]}\n"
                                 "sensor_motion: {twist: {velocity_m_s: [2, 0, 0]}}\n")
        columns = ("--columns", "xyz,time,ring", "--frame", "world", "--drop-invalid")
        self.succeed("render", "scene.yaml", "--duration", "0.3", "--deskew", "--ground-truth", *columns, "-o", "a.csv")
        self.assertEqual([name for name in self.files() if name.endswith(".csv")],
                         ["a_000000.csv", "a_000001.csv", "a_000002.csv"])
        times = []
        for k in range(3):
            with open(os.path.join(self.folder, f"a_00000{k}.csv"), encoding="utf-8") as file:
                next(file)
                rows = [[float(number) for number in line.split(",")] for line in file]
            # Deskewed, every point is on a wall of the room; CSV keeps all digits.
            self.assertLess(max(abs(max(map(abs, row[:3])) - 8.0) for row in rows), 1e-9)
            times += [round(k * 1e8) + row[3] for row in rows if row[4] == rows[0][4]]
        steps = [later - earlier for earlier, later in zip(sorted(times), sorted(times)[1:])]
        self.assertLessEqual(max(abs(step - 55296.0) for step in steps), 1.0)  # VLP-16, in ns

    def test_a_sequence_names_its_frames_in_the_sidecar(self):
        self.succeed("render", "builtin:box", "--duration", "0.05", "--rate", "40", "-o", "b.pcd")
        self.assertEqual(self.files(), ["b_000000.pcd", "b_000000.pcd.json", "b_000001.pcd",
                                        "b_000001.pcd.json"])
        self.assertIn("--duration", self.refused("render", "builtin:box", "--duration", "-1", "-o", "b.pcd"))
        self.assertIn("a million frames",
                      self.refused("render", "builtin:box", "--duration", "1e9", "-o", "b.pcd"))


if __name__ == "__main__":
    unittest.main()
