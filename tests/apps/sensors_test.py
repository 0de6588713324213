# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Sensor and surface presets on the command line. The built program is found in PATH."""

import json
import os
import unittest

from cli_support import CliTest


class Sensors(CliTest):
    def test_the_list_has_every_preset(self):
        lines = self.succeed("sensors").stdout.splitlines()
        names = {line.split()[0] for line in lines[1:]}
        self.assertLessEqual({"VLP-16", "OS1-128", "Livox-Avia", "D435", "TiM781"}, names)
        reported = {entry["name"]: entry for entry in json.loads(self.succeed("sensors", "--json").stdout)}
        self.assertEqual(set(reported), names)
        self.assertEqual(reported["VLP-16"]["rows"], 16)
        self.assertEqual(reported["VLP-16"]["view_deg"][0], 360)

    def test_the_list_counts_the_values_with_sources(self):
        lines = {line.split()[0]: line for line in self.succeed("sensors").stdout.splitlines()[1:]}
        for entry in json.loads(self.succeed("sensors", "--json").stdout):
            self.assertLess(0, entry["values"])
            self.assertTrue(lines[entry["name"]].endswith(f"{entry['backed']} of {entry['values']}"), entry["name"])
        text = self.succeed("sensors", "VLP-16").stdout
        stars = [line for line in text.splitlines() if line.startswith("* ") and " = " in line]
        backed, values = map(int, lines["VLP-16"].split("  ")[-1].split(" of "))
        typed = [line for line in stars if line.split(" = ")[0].endswith(("type", "kind"))]
        self.assertEqual(len(stars) - len(typed), values - backed)

    def test_a_part_of_a_name_lists_the_presets_with_it(self):
        def names(*arguments):
            return [line.split()[0] for line in self.succeed("sensors", *arguments).stdout.splitlines()[1:]]

        self.assertLessEqual({"OS1-128", "OS1-32", "OS1-64"}, set(names("ouster os1")))
        self.assertEqual(names("velodyne hdl"), ["HDL-32E", "HDL-64E-S1", "HDL-64E-S2", "HDL-64E-S3", "HDL-64E-S3-unit-2"])
        listed = json.loads(self.succeed("sensors", "velodyne_HDL", "--json").stdout)
        self.assertEqual([one["name"] for one in listed], ["HDL-32E", "HDL-64E-S1", "HDL-64E-S2", "HDL-64E-S3", "HDL-64E-S3-unit-2"])
        self.assertIn("--mode: no sensor is given", self.refused("sensors", "ouster", "--mode", "512x10"))
        self.assertIn("did you mean OS1-16, OS1-64", self.refused("sensors", "os1-46"))

    def test_a_sensor_prints_its_aliases_and_the_values_of_the_chosen_mode(self):
        lines = self.succeed("sensors", "os1").stdout.splitlines()
        self.assertEqual(lines[0], "Ouster OS1-128")
        self.assertRegex(lines[1], "^aliases: .*OS1")
        self.assertEqual(lines[2], "modes: 512x10, 1024x10 (this one), 2048x10, 512x20, 1024x20")
        fast = self.succeed("sensors", "OS1-32", "--mode", "512x20").stdout
        self.assertIn("1024x10, 2048x10, 512x20 (this one)", fast)
        self.assertIn("optics.columns_per_turn = 512\n", fast)
        self.assertIn("rate_hz = 20\n", fast)
        one = json.loads(self.succeed("sensors", "OS1-32", "--mode", "512x20", "--json").stdout)
        self.assertEqual((one["mode"], one["cols"], one["aliases"]), ("512x20", 512, []))
        self.assertIn("--mode: '512x21' is no mode of Ouster OS1-32; allowed: 512x10, 1024x10",
                      self.refused("sensors", "OS1-32", "--mode", "512x21"))

    def test_a_cloud_in_a_mode_records_it_and_is_replayed_and_explained(self):
        self.succeed("render", "builtin:box", "--eye", "0,0,0", "--sensor", "os1-32", "--mode", "512x20", "-o", "a.pcd")
        with open(os.path.join(self.folder, "a.glidar.json"), encoding="utf-8") as file:
            sidecar = json.load(file)
        self.assertEqual((sidecar["sensor"]["variant"], sidecar["sensor"]["mode"]), ("OS1-32", "512x20"))
        self.assertEqual((sidecar["sensor"]["rate_hz"], sidecar["sensor"]["cols"]), (20, 512))
        self.assertEqual(sidecar["sensor"]["optics"]["columns_per_turn"], 512)
        before = self.bytes_of("a.pcd")
        self.assertIn("5 of 16384", self.succeed("explain", "a.pcd", "--index", "5").stdout)
        self.succeed("render", *sidecar["command"]["arguments"][1:])
        self.assertEqual(self.bytes_of("a.pcd"), before)
        self.assertIn("--mode: there is no --sensor", self.refused("render", "builtin:box", "--mode", "512x20", "-o", "a.pcd"))

    def test_a_file_with_variants_lists_them_unless_one_is_chosen(self):
        self.write("my.yaml", "optics: {width: 4, height: 3, fov_deg: 20}\nmodes: {slow: {rate_hz: 1}}\n"
                              "variants: {A: {}, B: {optics: {width: 9}, rate_hz: x}, C: {optics: {width: 7}}}\n")
        box = ("render", "builtin:box", "-o", "a.pcd", "--sensor")
        self.assertIn("my.yaml: it is a family of sensors; allowed: one of its variants: A, B, C; "
                      "choose one: 'my.yaml#A'", self.refused(*box, "my.yaml"))
        self.assertIn("my.yaml:3:52: rate_hz (variant B): 'x'", self.refused(*box, "my.yaml#B"))
        self.assertIn("3 x 7 beams", self.succeed(*box, "my.yaml#C", "--mode", "slow").stdout)

    def test_surfaces_are_listed_and_applied_to_a_model(self):
        lines = self.succeed("sensors", "--surfaces").stdout.splitlines()
        asphalt = next(line for line in lines if line.startswith("asphalt "))
        self.assertEqual(asphalt.split()[1:5], ["0.269", "0.278", "0.302", "0.362"])
        reported = {entry["name"]: entry
                for entry in json.loads(self.succeed("sensors", "--surfaces", "--json").stdout)}
        self.assertEqual(reported["grass"]["reflectance_at_nm"]["1550"], 0.243)
        self.assertFalse(reported["mli"]["diffuse"])
        self.assertIn("--surfaces alone", self.refused("sensors", "VLP-16", "--surfaces"))

        box = ("render", "builtin:box", "--eye", "0,0,0", "-o", "a.csv", "--surface")
        lidar = ("--sensor", "VLP-16", "--columns", "xyz,intensity")
        self.succeed(*box, "black_paint", *lidar)
        with open(os.path.join(self.folder, "a.csv"), encoding="utf-8") as file:
            next(file)
            counts = {float(line.split(",")[3]) for line in file}
        self.assertEqual(max(counts), 5)  # percent, at normal incidence
        self.assertIn("did you mean 'black_paint'?", self.refused(*box, "blak_paint", *lidar))
        self.assertIn("no pulsed light", self.refused(*box, "grass"))
        self.write("s.yaml", "models: [{model: builtin:box}]\nsensor: VLP-16\n")
        self.assertIn("scene file", self.refused("render", "s.yaml", "--surface", "grass", "-o", "a.csv"))

    def test_a_sensor_prints_its_sources_and_draws_its_pattern(self):
        text = self.succeed("sensors", "vlp-16", "-o", "pattern.png").stdout
        self.assertIn("optics.firing_period_us = 55.296", text)
        self.assertIn("VLP-16 manual", text)
        with open(os.path.join(self.folder, "pattern.png"), "rb") as file:
            self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")
        self.assertIn("did you mean VLP-16?", self.refused("sensors", "VLP-17"))
        self.assertIn("no sensor is given", self.refused("sensors", "-o", "x.png"))

    def test_a_pattern_needs_the_suffix_png(self):
        self.succeed("sensors", "vlp-16", "-o", "UPPER.PNG")
        for name in ("x.pcd", "x", "png", "x.png.pcd"):
            self.assertIn(f"--output: '{name}'; allowed: a name that ends in .png",
                          self.refused("sensors", "VLP-16", "-o", name))
            self.assertFalse(os.path.exists(os.path.join(self.folder, name)))

    def test_renders_with_a_preset(self):
        self.write("walls.yaml", "models: [{model: builtin:box, scale: 4}]\n")
        done = self.succeed("render", "walls.yaml", "--sensor", "vlp-16", "--eye", "0,0,0",
                            "--columns", "xyz,range,ring,time", "-o", "room.npz")
        self.assertIn("16 x 1809 beams, 28944 hits (100.0 %)", done.stdout)
        with open(os.path.join(self.folder, "room.glidar.json"), encoding="utf-8") as file:
            sensor = json.load(file)["sensor"]
        self.assertEqual(sensor["optics"]["type"], "spinning")
        self.assertEqual(sensor["frame_id"], "lidar_frame")
        self.assertEqual(len(sensor["optics"]["elevation_deg"]), 16)

    def test_ground_truth_removes_the_noise_of_a_preset(self):
        self.write("room.yaml", "models: [{model: builtin:box, scale: 4}]\nsensor: VLP-16\n"
                                "sensor_pose: {position: [0, 0, 0]}\n")
        walls = []
        for ideal in ((), ("--ground-truth",)):
            self.succeed("render", "room.yaml", *ideal, "-o", "room.csv")
            with open(os.path.join(self.folder, "room.csv"), encoding="utf-8") as file:
                next(file)
                walls.append([max(abs(float(x)) for x in line.split(",")[:3]) for line in file])
            with open(os.path.join(self.folder, "room.glidar.json"), encoding="utf-8") as file:
                sensor = json.load(file)["sensor"]
            self.assertEqual(bool(sensor["noise"]), not ideal)
            self.assertEqual(sensor["lidar_equation"] is None, bool(ideal))
        self.assertGreater(max(abs(wall - 4) for wall in walls[0]), 0.01)
        self.assertLess(max(abs(wall - 4) for wall in walls[1]), 1e-9)

    def test_options_of_the_paper_s_light_are_refused_for_pulsed_light(self):
        box = ("render", "builtin:box", "--eye", "0,0,0", "--sensor", "VLP-16", "-o", "a.pcd")
        self.assertIn("--ambient: the sensor has pulsed light; leave it out, or add --ground-truth",
                      self.refused(*box, "--ambient", "0"))
        self.assertIn("--attenuation: the sensor has", self.refused(*box, "--attenuation", "1,0,0"))
        self.succeed(*box, "--ambient", "0", "--ground-truth")

    def test_without_a_pose_a_lidar_is_beside_the_scene_with_a_note(self):
        done = self.succeed("render", "builtin:asteroid", "--sensor", "OS1-32", "-o", "a.pcd")
        self.assertIn("beside the scene", done.stderr)
        self.assertNotIn(" 0 hits", done.stdout)

    def test_a_layout_has_the_driver_s_fields(self):
        self.succeed("render", "builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0", "--layout", "velodyne",
                     "-o", "v.pcd", "-o", "v.csv", "-o", "v.png", "--quiet")
        head = self.bytes_of("v.pcd").split(b"DATA")[0].decode()
        self.assertIn("FIELDS x y z intensity ring time\nSIZE 4 4 4 4 2 4\nTYPE F F F F U F\n", head)
        names, *rows = self.bytes_of("v.csv").decode().splitlines()
        self.assertEqual(names, "x,y,z,intensity,ring,time")
        times = [float(row.split(",")[5]) for row in rows]
        self.assertTrue(0.0 <= min(times) < 1e-4 and 0.0999 < max(times) < 0.1001, (min(times), max(times)))
        self.assertEqual({int(row.split(",")[4]) for row in rows}, set(range(16)))
        self.assertIn("  velodyne       velodyne_pointcloud: x y z intensity ring time\n",
                      self.succeed("render", "--help").stdout)

    def test_beams_and_returns_are_printed_with_their_sources(self):
        text = self.succeed("sensors", "VLS-128").stdout
        self.assertIn("\n  footprint.divergence_mrad = 3, 1.5\n      VLS-128 User Manual, table F-1", text)
        self.assertIn("\n* receiver.pulse_ns = 6\n", text)
        self.assertIn("\n  receiver.returns = strongest\n", text)
        self.assertIn(" 5.1 x 2.5 ", text)  # 1.699 times the widths at half maximum
        reported = {entry["name"]: entry for entry in json.loads(self.succeed("sensors", "--json").stdout)}
        self.assertAlmostEqual(reported["VLS-128"]["divergence_mrad"][0], 3 * 1.699, 2)
        self.assertEqual(reported["Livox-Avia"]["returns"], ["first"])
        self.assertIsNone(reported["UTM-30LX"]["divergence_mrad"])
        self.assertEqual(reported["D435"]["returns"], [])

    def test_returns_can_be_selected(self):
        self.write("walls.yaml", "models: [{model: builtin:box, scale: 4}]\n")
        room = ("render", "walls.yaml", "--eye", "0,0,0", "--sensor", "VLP-16", "--returns")
        done = self.succeed(*room, "strongest,last", "-o", "a.pcd")
        self.assertIn("16 x 1809 beams, 2 returns, 28944 hits (50.0 %)", done.stdout)  # a wall returns one echo
        with open(os.path.join(self.folder, "a.glidar.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file)["sensor"]["receiver"]["returns"], ["strongest", "last"])
        self.assertIn("16 x 1809 beams, 3 returns, ", self.succeed(*room, "3", "-o", "a.pcd").stdout)
        for wrong, reported in (("lst", "'lst'; allowed: 1 to 16 of first, second, third, last, strongest, "),
                            ("strongst", "did you mean strongest?"), ("first,", "an empty part"),
                            ("0", "how many of the nearest, 1 to 16"), (",".join(["last"] * 17), "17 returns")):
            self.assertIn(reported, self.refused(*room, wrong, "-o", "a.pcd"))
        self.assertIn("--returns: --ground-truth removes", self.refused(*room, "last", "--ground-truth", "-o", "a.pcd"))
        self.assertIn("--returns: the sensor has no pulse light", self.refused(
            "render", "builtin:box", "--returns", "last", "-o", "a.pcd"))

    def test_columns_and_rate_can_be_selected(self):
        done = self.succeed("render", "builtin:box", "--eye", "0,0,0", "--sensor", "OS1-32",
                            "--columns-per-turn", "512", "--rate", "20", "-o", "a.pcd")
        self.assertIn("32 x 512 beams", done.stdout)
        self.assertIn("does not spin", self.refused(
            "render", "builtin:box", "--sensor", "D435", "--columns-per-turn", "5", "-o", "x.pcd"))


if __name__ == "__main__":
    unittest.main()
