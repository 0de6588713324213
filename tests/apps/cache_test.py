#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What the commands print about the model cache. The built program is found in PATH."""

import os
import unittest

from cli_support import BOX, CliTest


class Cache(CliTest):
    def setUp(self):
        super().setUp()
        self.write("box.obj", BOX)

    def test_a_folder_that_others_may_access_is_warned_of(self):
        shared = os.path.join(self.folder, "shared")
        os.mkdir(shared)
        os.chmod(shared, 0o755)
        for command in (("info",), ("render", "-o", "x.pcd")):
            warning = self.succeed(*command, "box.obj", "--cache-folder", "shared").stderr
            self.assertIn("glidar: warning: the cache folder shared is accessible to other users (mode 0755)", warning)
            self.assertIn("chmod 700 'shared'", warning)
        self.assertEqual(os.listdir(shared), [])

    def test_the_warning_is_printed_once_for_a_scene(self):
        os.mkdir(os.path.join(self.folder, "shared"))
        os.chmod(os.path.join(self.folder, "shared"), 0o750)
        self.write("box2.obj", BOX)
        self.write("scene.yaml", "models: [{model: box.obj}, {model: box2.obj}]\nsensor_pose: {position: [0, 0, -9]}\n"
                                 "sensor: {optics: {type: pinhole, width: 4, height: 4, fov_deg: 20}}\n")
        done = self.succeed("render", "scene.yaml", "--cache-folder", "shared", "-o", "x.pcd")
        self.assertEqual(done.stderr.count("the cache folder shared"), 1, done.stderr)

    def test_a_limit_that_is_no_number_is_refused(self):
        self.environment["GLIDAR_CACHE_LIMIT_MIB"] = "2G"
        error = self.refused("info", "box.obj")
        self.assertIn("GLIDAR_CACHE_LIMIT_MIB: 2G; allowed: a whole number of MiB", error)


if __name__ == "__main__":
    unittest.main()
