# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Layouts of clouds from the command line. The built program is found in PATH."""

import unittest

from cli_support import CliTest


class Layouts(CliTest):
    def test_a_layout_gives_the_drivers_fields(self):
        self.succeed("render", "builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0", "--layout", "velodyne",
                     "-o", "v.pcd", "-o", "v.csv", "-o", "v.png", "--quiet")
        head = self.bytes_of("v.pcd").split(b"DATA")[0].decode()
        self.assertIn("FIELDS x y z intensity ring time\nSIZE 4 4 4 4 2 4\nTYPE F F F F U F\n", head)
        names, *rows = self.bytes_of("v.csv").decode().splitlines()
        self.assertEqual(names, "x,y,z,intensity,ring,time")
        times = [float(row.split(",")[5]) for row in rows]
        self.assertTrue(0.0 <= min(times) < 1e-4 and 0.0999 < max(times) < 0.1001, (min(times), max(times)))
        self.assertEqual({int(row.split(",")[4]) for row in rows}, set(range(16)))

    def test_help_tells_the_fields_of_each(self):
        text = self.succeed("render", "--help").stdout
        self.assertIn("  velodyne     velodyne_pointcloud: x y z intensity ring time\n", text)


if __name__ == "__main__":
    unittest.main()
