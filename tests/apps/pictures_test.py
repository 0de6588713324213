# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of clouds from the command line. The built program is found in PATH."""

import os
import unittest

from cli_support import CliTest
from skipping import importing

with importing():
    import numpy as np
    from PIL import Image

NO_RETURN = (44, 44, 52)
LIDAR = ("render", "builtin:box", "--sensor", "VLP-16", "--eye", "0.2,0.1,0")


class Pictures(CliTest):
    def pixels(self, name):
        with Image.open(os.path.join(self.folder, name)) as image:
            return np.asarray(image.convert("RGB")).astype(int)

    def test_a_vertical_edge_is_vertical_in_the_image_of_an_ouster(self):
        # The near face of a box 5 m ahead spans 2 atan(1 / 4) degrees: its left edge is in one column.
        self.write("s.yaml", "models: [{model: builtin:box, pose: {position: [5, 0, 0]}}]\nsensor: OS1-128\n"
                             "sensor_pose: {position: [0, 0, 0]}\n")
        self.succeed("render", "s.yaml", "--ground-truth", "-o", "a.png")
        plot = self.pixels("a.png")[56:56 + 128, 100:100 + 1024]  # its position follows from the size of the letters
        self.assertEqual(tuple(plot[0, 0]), NO_RETURN)
        is_hit = (plot != NO_RETURN).any(axis=2)
        # Up to 10 degrees; higher beams miss the corners of the face.
        edges = [int(row.argmax()) for row in is_hit[32:92]]
        self.assertTrue(is_hit[32:92].any(axis=1).all())
        self.assertLessEqual(max(edges) - min(edges), 1)
        self.assertAlmostEqual(np.mean(edges), (180 - np.degrees(np.arctan(0.25))) / 360 * 1024, delta=1.5)

    def test_a_known_point_is_in_its_pixel_from_above(self):
        # A wall at x = 2 m, seen from the origin of a room: the column of the picture follows from the axis.
        self.write("s.yaml", "models: [{model: builtin:plane, scale: 3, pose: {position: [2, 0, 0], "
                             "euler_deg: {pitch: -90}}}]\nsensor: VLP-16\nsensor_pose: {position: [0, 0, 0]}\n")
        self.succeed("render", "s.yaml", "--ground-truth", "-o", "a.bev.png")
        image = self.pixels("a.bev.png")
        self.assertEqual(image.shape, (1000, 1400, 3))
        saturation = image.max(axis=2) - image.min(axis=2)
        is_point = saturation[:820] > 40  # the colour bar is below
        columns = np.flatnonzero(is_point.any(axis=0))
        self.assertLessEqual(columns.max() - columns.min(), 5)  # one dot: x is 2 m everywhere
        is_sensor = (image[:820] == 255).all(axis=2)
        rows = np.flatnonzero(is_point.any(axis=1))
        sensor = np.argwhere(is_sensor & (np.abs(np.arange(820) - rows.mean())[:, None] < 15))
        pixels_per_m = (rows.max() - rows.min()) / 6.0  # the plane is 6 m wide
        self.assertAlmostEqual((columns.mean() - sensor[:, 1].mean()) / pixels_per_m, 2.0, delta=0.1)

    def test_pictures_are_the_same_bytes_for_any_number_of_threads(self):
        for name in ("a.png", "a.bev.png", "a.view.png"):
            found = []
            for threads in ("1", "3"):
                self.succeed(*LIDAR, "--threads", threads, "--colour-by", "intensity", "-o", name)
                with open(os.path.join(self.folder, name), "rb") as file:
                    found.append(file.read())
            self.assertEqual(found[0], found[1], name)

    def test_outliers_do_not_change_the_colours_of_a_room(self):
        # A box of 8 mm just before the sensor, which about twenty of 131072 beams hit.
        room = "models:\n  - {model: builtin:box, scale: 2}\n"
        tiny = "  - {model: builtin:box, scale: 0.004, pose: {position: [0.3, 0.006, 0]}}\n"
        pictures = []
        for text in (room, room + tiny):
            self.write("s.yaml", text + "sensor: OS1-128\nsensor_pose: {position: [0, 0, 0]}\n")
            self.succeed("render", "s.yaml", "--ground-truth", "-o", "a.png")
            pictures.append(self.pixels("a.png")[56:56 + 128, 100:100 + 400])
        self.assertLess(np.abs(pictures[0] - pictures[1]).max(), 12)

    def test_sizes_and_colours_are_as_requested(self):
        self.succeed(*LIDAR, "--colour-by", "ring", "--picture-size", "300x200", "-o", "a.bev.png",
                     "--view-eye", "-3,0,2", "--view-target", "0,0,0", "-o", "a.view.png")
        self.assertEqual(self.pixels("a.bev.png").shape, (200, 300, 3))
        self.assertEqual(self.pixels("a.view.png").shape, (200, 300, 3))

    def test_invalid_combinations_are_refused_and_leave_no_file(self):
        for options, words in (
                (("--colour-by", "heat"), "--colour-by"),
                (("--picture-size", "300"), "--picture-size: '300'; allowed: WIDTHxHEIGHT in pixels"),
                (("--picture-size", "300x9999"), "each from 200 to 8192"),
                (("--view-eye", "1,2"), "--view-eye"),
                (("--view-eye", "1,2,3", "--view-target", "1,2,3"), "it is the point that the camera looks at")):
            self.assertIn(words, self.refused(*LIDAR, *options, "-o", "a.view.png"))
        self.assertIn("a camera has no rings",
                      self.refused("render", "builtin:box", "--colour-by", "ring", "-o", "a.view.png"))
        self.assertFalse(os.path.exists(os.path.join(self.folder, "a.view.png")))


if __name__ == "__main__":
    unittest.main()
