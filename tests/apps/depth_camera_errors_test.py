#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar render of depth cameras from raw images: wrong outputs, models, renderers, keys and sizes of images."""

import re
import unittest

from cli_support import CliTest

BOX = ("render", "builtin:box")
PHYSICAL = ("--depth-model", "physical")
STEREO = """
optics: {width: 64, height: 40, fx: 60, fy: 60}
wavelength_nm: 850
depth_model: physical
depth_camera: {type: active_stereo, baseline_m: 0.05, matcher: {disparities: 16}}
"""
TOF = """
optics: {width: 8, height: 6, fov_x_deg: 40}
wavelength_nm: 850
depth_model: physical
depth_camera: {type: time_of_flight, signal_electrons: 2e6, decoder: {frequencies_hz: [15e6]}}
"""


class WrongUses(CliTest):
    def refuse(self, words, *arguments):
        self.assertIn(words, self.refused(*BOX, *arguments))

    def test_images_of_another_type_of_camera_are_refused(self):
        stereo, tof = ("--sensor", self.write("s.yaml", STEREO)), ("--sensor", self.write("t.yaml", TOF))
        for suffix in ("tof.npy", "ir.png"):
            self.refuse("without raw time-of-flight images", *stereo, "-o", f"a.{suffix}")
        self.refuse("without the raw image 'ir_reference'; allowed: .ir_left.png, .ir_right.png", *stereo, "-o",
                    "a.ir_reference.png")
        for name in ("ir_left", "ir_right", "ir_reference"):
            self.refuse(f"without the raw image '{name}'", *tof, "-o", f"a.{name}.png")

    def test_one_wrong_output_leaves_none(self):
        stereo = ("--sensor", self.write("s.yaml", STEREO))
        self.refuse("without raw time-of-flight images", *stereo, "-o", "a.ir_left.png", "-o", "a.pcd", "-o", "a.tof.npy")

    def test_the_model_law_has_no_images(self):
        stereo, tof = ("--sensor", self.write("s.yaml", STEREO)), ("--sensor", self.write("t.yaml", TOF))
        for law in (("--depth-model", "law"), ("--ground-truth",)):
            self.refuse("--depth-model physical, such as D435", *stereo, *law, "-o", "a.ir_left.png")
            self.refuse("--depth-model physical, such as Kinect-v2", *tof, *law, "-o", "a.tof.npy")

    def test_a_stored_pattern_is_no_right_image(self):
        pattern = STEREO.replace("baseline_m: 0.05", "baseline_m: 0.05, reference: pattern, projector: {origin_m: [0.05, 0, 0]}")
        self.refuse("allowed: .ir_left.png, .ir_reference.png", "--sensor", self.write("k.yaml", pattern), "-o",
                    "a.ir_right.png")

    def test_sensors_without_a_depth_camera_have_no_physical_model(self):
        for sensor in (("--sensor", "VLP-16"), ("--sensor", "D405"), ()):
            self.refuse("has no depth_camera; allowed: law, or a sensor with a depth_camera", *sensor, *PHYSICAL, "-o", "a.pcd")
        self.succeed(*BOX, "--sensor", "VLP-16", "--depth-model", "law", "-o", "a.pcd")

    def test_unknown_models_are_refused(self):
        self.refuse("--depth-model: 'real'; allowed: law, physical", "--sensor", "D435", "--depth-model", "real", "-o", "a.pcd")

    def test_renderers_without_rays_are_refused_with_the_one_that_works(self):
        for name, text in (("s.yaml", STEREO), ("t.yaml", TOF)):
            sensor = ("--sensor", self.write(name, text))
            self.refuse("use --renderer rays", *sensor, "--renderer", "raster", "-o", "a.pcd")


class Sizes(CliTest):
    def sensor(self, text, width, height):
        return self.write("s.yaml", re.sub(r"width: \d+, height: \d+", f"width: {width}, height: {height}", text))

    def test_a_time_of_flight_camera_may_have_one_pixel(self):
        done = self.succeed(*BOX, "--sensor", self.sensor(TOF, 1, 1), "-o", "a.tof.npy", "-o", "a.ir.png", "-o", "a.csv")
        self.assertIn("1 x 1 beams, 1 hits", done.stdout)

    def test_a_stereo_camera_is_at_least_as_wide_as_its_search(self):
        few = STEREO.replace("disparities: 16", "disparities: 2")
        error = self.refused(*BOX, "--sensor", self.sensor(few, 1, 1), "-o", "a.pcd")
        self.assertIn("min_disparity_px + disparities is 2, wider than the image; allowed: at most its 1 columns", error)
        self.succeed(*BOX, "--sensor", self.sensor(few, 2, 1), "-o", "a.ir_left.png", "-o", "a.pcd")

    def test_images_too_large_for_the_memory_are_refused_at_once(self):
        for text, width, height, words in (
                (STEREO, 65536, 65536, "have too many costs"), (STEREO, 5000, 5000, "depth_camera: sub_rays is 3, so that 5000x5000 pixels have too many rays"),
                (TOF, 65536, 65536, "have too many rays"), (TOF, 2000, 2000, "have too many rays"),
                (TOF, 65537, 1, "allowed: a whole number from 1 to 65536"), (STEREO, 0, 4, "allowed: a whole number from 1 to")):
            with self.subTest(width=width, height=height, words=words):
                self.assertIn(words, self.refused(*BOX, "--sensor", self.sensor(text, width, height), "-o", "a.pcd"))


class Keys(CliTest):
    def error_of(self, text):
        return self.refused(*BOX, "--sensor", self.write("s.yaml", text), "-o", "a.pcd")

    def test_unknown_keys_name_the_nearest_one_and_their_place(self):
        for text, wrong, nearest in (
                (STEREO, "base_line_m: 0.1", "baseline_m"), (STEREO, "sub_ray: 2", "sub_rays"),
                (TOF, "signal_electron: 3", "signal_electrons"), (TOF, "bounce_ray: 3", "bounce_rays")):
            error = self.error_of(text.replace("{type: ", f"{{{wrong}, type: "))
            self.assertRegex(error, r"s\.yaml:5:\d+: ")
            self.assertIn(f"did you mean '{nearest}'?", error)
        self.assertIn("did you mean 'disparities'?", self.error_of(STEREO.replace("disparities", "disparites")))
        self.assertIn("did you mean 'frequencies_hz'?", self.error_of(TOF.replace("[15e6]", "[15e6], frequency_hz: [15e6]")))

    def test_exposures_take_at_most_four_seconds_together(self):
        for interval_s, seconds in ((1.25, "5"), (1e300, "4e+300")):
            error = self.error_of(TOF.replace("{type: ", f"{{step_interval_s: {interval_s:g}, type: "))
            self.assertRegex(error, r"s\.yaml:5:\d+: ")
            self.assertIn(f"so that 4 phase steps take {seconds} s; allowed: at most 4 s", error)

    def test_a_missing_type_and_an_unknown_one_are_refused(self):
        self.assertIn("active_stereo", self.error_of(STEREO.replace("active_stereo", "activ_stereo")))
        self.assertIn("type", self.error_of(STEREO.replace("type: active_stereo, ", "")))

    def test_required_keys_are_named(self):
        self.assertIn("signal_electrons", self.error_of(TOF.replace("signal_electrons: 2e6, ", "")))
        self.assertIn("frequencies_hz", self.error_of(TOF.replace("frequencies_hz: [15e6]", "taps: 3")))


if __name__ == "__main__":
    unittest.main()
