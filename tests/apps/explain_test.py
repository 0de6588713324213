# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar explain. The built program is found in PATH."""

import json
import os
import re
import shlex
import shutil
import unittest

from cli_support import CliTest, box_of

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
SENSOR = """
optics: {type: pinhole, width: 24, height: 20, fov_deg: 30}
wavelength_nm: 905
lidar_equation: {reference_reflectance: 0.8, reference_range_m: 100, noise_sigma: 0.2}
footprint: {divergence_mrad: 3}
receiver: {returns: [first, last]}
weather: {rain_mm_per_h: 20, visibility_m: 60}
noise: [{type: range_gaussian, sigma_m: 0.02}, {type: dropout, probability: 0.3}]
"""


class Explain(CliTest):
    def points_of(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8") as file:
            columns = next(file).strip().split(",")
            return [dict(zip(columns, line.strip().split(","))) for line in file]

    def trace_of(self, *arguments):
        """The trace's lines by their heads; those without a head belong to the previous one."""
        trace = {}
        for line in self.succeed("explain", *arguments).stdout.splitlines():
            head = line[:10].strip() or head
            trace.setdefault(head, []).append(line[10:])
        return trace

    def assert_is_trace_of(self, trace, point):
        reported = re.match(r"([-0-9.]+) m, intensity ([-+0-9.e]+)", trace["reported"][0])
        if reported is None:
            self.assertEqual(float(point["status"]) == 0, False)
            return
        self.assertAlmostEqual(float(reported[1]), float(point["range"]), delta=1e-6)
        self.assertAlmostEqual(float(reported[2]), float(point["intensity"]), delta=1e-5 * float(reported[2]))

    def test_a_damaged_sidecar_is_explained_in_plain_words(self):
        self.succeed("render", "builtin:box", "--width", "8", "--height", "6", "-o", "a.pcd")
        good = self.bytes_of("a.glidar.json").decode()
        for text, words in ((good[:100], "a damaged file: its text ends too early, at line "),
                            (good.replace('"frame_hash"', '"hash"'), "the key 'frame_hash' is missing")):
            self.write("a.glidar.json", text)
            error = self.refused("explain", "a.pcd", "--index", "0")
            self.assertIn("a.glidar.json: ", error)
            self.assertIn(words, error)
            self.assertIn("write the cloud again", error)
            self.assertNotIn("exception", error)

    def test_errors_quote_at_most_8_kib_of_a_sidecar(self):
        self.succeed("render", "builtin:box", "--width", "8", "--height", "6", "-o", "a.pcd")
        sidecar = json.loads(self.bytes_of("a.glidar.json"))
        sidecar["command"]["arguments"][1] = "x" * 131071
        self.write("a.glidar.json", json.dumps(sidecar))
        error = self.refused("explain", "a.pcd", "--index", "0")
        self.assertTrue(error.startswith("glidar: error: xxx"), error[:30])
        self.assertLess(len(error), 8300)

    def test_the_trace_of_every_point_ends_at_its_reported_values(self):
        self.write("s.yaml", SENSOR)
        columns = ("--columns", "xyz,range,intensity,status,row,col,return")
        self.succeed("render", "builtin:asteroid", "--sensor", "s.yaml", "--seed", "5", *columns, "-o", "all.csv")
        self.succeed("render", "builtin:asteroid", "--sensor", "s.yaml", "--seed", "5", *columns, "--drop-invalid",
                     "-o", "dense.csv")
        everything, dense = self.points_of("all.csv"), self.points_of("dense.csv")
        self.assertGreater(len(everything), len(dense))
        for index in (0, 200, 252, 253, 700, len(everything) - 1):
            self.assert_is_trace_of(self.trace_of("all.csv", "--index", str(index)), everything[index])
        for index in (0, len(dense) // 2, len(dense) - 1):
            point = dense[index]
            trace = self.trace_of("dense.csv", "--index", str(index))
            self.assert_is_trace_of(trace, point)
            by_pixel = self.trace_of("dense.csv", "--row", point["row"], "--col", point["col"], "--return",
                                     point["return"])
            self.assertEqual(by_pixel, trace)

    def test_the_trace_lists_beam_hit_light_echoes_and_random_numbers(self):
        self.write("s.yaml", SENSOR)
        self.succeed("render", "builtin:asteroid", "--sensor", "s.yaml", "-o", "a.npz")
        trace = self.trace_of("a.npz", "--row", "10", "--col", "12")
        self.assertEqual(list(trace), ["beam", "fired", "nominal", "ray", "hit", "light", "paths", "echoes",
                                       "received", "measured", "noise 1", "noise 2", "reported", "error"][:len(trace)])
        self.assertIn("asteroid", trace["hit"][0])
        self.assertIn("sub-rays", trace["paths"][0])
        self.assertRegex(trace["echoes"][1], r", sigma \S+ m, .*; standard normal -?\d+\.\d+$")
        self.assertIn("range_gaussian sigma_m 0.02", trace["noise 1"][0])

    def test_the_trace_lists_thresholds_and_window_means(self):
        self.write("s.yaml", """
optics: {type: pinhole, width: 24, height: 20, fov_deg: 30}
noise: [{type: kinect_v1, window: 5}, {type: dropout, probability: 0.1, by_range_m: [[0, 0.5], [1000, 0.5]]}]
""")
        self.succeed("render", "builtin:asteroid", "--sensor", "s.yaml", "-o", "a.csv",
                     "--columns", "xyz,range,intensity,status")
        trace = self.trace_of("a.csv", "--row", "10", "--col", "12")
        kinect, chance = trace["noise 1"], trace["noise 2"]
        self.assertRegex(kinect[2], r"^standard normal \S+: error of the disparity: the mean of 5 x 5 pixels' numbers")
        drawn = re.match(r"uniform (\S+): lost if below 0.55$", chance[1])
        self.assertIsNotNone(drawn, chance)
        self.assertEqual(chance[-1].startswith("result dropped"), float(drawn[1]) < 0.55)

    def test_the_reported_range_includes_the_sensors_range_offset(self):
        self.write("s.yaml", """
optics: {type: spinning, elevation_deg: [0], columns_per_turn: 60, beam_origin_mm: 500}
""")
        self.succeed("render", "builtin:box", "--sensor", "s.yaml", "--eye", "0,0,0", "-o", "a.csv", "--columns",
                     "xyz,range,intensity,status")
        trace = self.trace_of("a.csv", "--index", "7")
        self.assert_is_trace_of(trace, self.points_of("a.csv")[7])
        self.assertEqual(trace["offset"], ["+0.500000 m, added to the range in the cloud"])
        measured, reported = (float(trace[head][0].split()[0]) for head in ("measured", "reported"))
        self.assertAlmostEqual(reported, measured + 0.5, delta=2e-6)
        self.assertEqual(trace["error"], ["+0.000000 m relative to the ground truth"])

    def test_the_documented_example_prints_the_output_shown(self):
        with open(os.path.join(ROOT, "docs", "explain.md"), encoding="utf-8") as file:
            shown = file.read()
        commands = re.search(r"```sh\n(.*?)```", shown, re.DOTALL)[1].splitlines()
        reported = re.search(r"```text\n(.*?)```", shown, re.DOTALL)[1]
        for command in commands:
            name, *arguments = shlex.split(command)
            self.assertEqual(name, "glidar")
            done = self.succeed(*arguments)
        self.assertEqual(done.stdout, reported)

    def test_frames_of_a_sequence_and_moved_folders_are_found(self):
        self.write("box.obj", box_of(2))
        os.mkdir(os.path.join(self.folder, "out"))
        self.succeed("render", "box.obj", "--sensor-rate", "0,1,0", "--camera-z", "9", "--duration", "0.1",
                     "--threads", "1", "--quiet", "--per-frame", "-o", "out/b.csv", "--columns", "xyz,range,intensity,status")
        with open(os.path.join(self.folder, "out", "b_000002.glidar.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file)["frame"], 2)
        with open(os.path.join(self.folder, "out", "b.glidar.json"), encoding="utf-8") as file:
            reported = json.load(file)
        self.assertEqual(reported["command"]["folder"], "..")
        self.assertNotIn("--threads", reported["command"]["arguments"])
        self.assertNotIn("--quiet", reported["command"]["arguments"])
        moved = os.path.join(self.folder, "moved")
        os.mkdir(moved)
        for name in ("box.obj", "out"):
            shutil.move(os.path.join(self.folder, name), moved)
        points = self.points_of("moved/out/b_000002.csv")
        trace = self.trace_of("moved/out/b_000002.csv", "--index", "30000")
        self.assertIn("frame 2", trace["fired"][0])
        self.assert_is_trace_of(trace, points[30000])

    def test_clouds_that_cannot_be_explained_are_errors(self):
        self.write("box.obj", box_of(2))
        self.succeed("render", "box.obj", "-w", "8", "--height", "8", "-o", "b.pcd", "--drop-invalid")
        self.succeed("render", "box.obj", "-w", "8", "--height", "8", "-o", "none.pcd", "--no-sidecar")
        explain = lambda *arguments: self.refused("explain", *arguments)
        self.assertIn("without --no-sidecar", explain("none.pcd", "--index", "0"))
        self.assertIn("--index N, or --row R and --col C", explain("b.pcd"))
        self.assertIn("--index N, or --row R and --col C", explain("b.pcd", "--row", "1"))
        self.assertIn("--index N, or --row R and --col C", explain("b.pcd", "--index", "1", "--return", "1"))
        self.assertIn("in two ways", explain("b.pcd", "--index", "1", "--row", "1", "--col", "1"))
        self.assertIn("--index: 64; allowed: below 39", explain("b.pcd", "--index", "64"))
        self.assertIn("8 rows, 8 columns, 1 returns, each from 0", explain("b.pcd", "--row", "8", "--col", "0"))
        self.assertIn("0, 0, 1; allowed", explain("b.pcd", "--row", "0", "--col", "0", "--return", "1"))
        self.assertIn("-1", explain("b.pcd", "--index", "-1"))
        self.write("box.obj", box_of(2.5))
        self.assertIn("the models have changed", explain("b.pcd", "--index", "0"))
        os.remove(os.path.join(self.folder, "box.obj"))
        self.assertIn("box.obj", explain("b.pcd", "--index", "0"))
        with open(os.path.join(self.folder, "b.glidar.json"), encoding="utf-8") as file:
            reported = json.load(file)
        for key, value in (("frame", 2 ** 40), ("frame", 1.5), ("command", {"arguments": [], "folder": 3}),
                           ("command", {"arguments": ["render", "--help"], "folder": "."}),
                           ("command", {"arguments": ["verify"], "folder": "."}),
                           ("command", {"arguments": reported["command"]["arguments"], "folder": "nowhere"})):
            self.write("b.glidar.json", json.dumps(dict(reported, **{key: value})))
            self.assertIn("b.glidar.json", explain("b.pcd", "--index", "0"))
        self.write("b.glidar.json", "{}")
        self.assertIn("not a sidecar", explain("b.pcd", "--index", "0"))

    def test_a_changed_sensor_file_is_noticed(self):
        self.write("s.yaml", SENSOR)
        self.succeed("render", "builtin:asteroid", "--sensor", "s.yaml", "-o", "a.pcd")
        self.write("s.yaml", SENSOR.replace("0.3", "0.9"))
        self.assertIn("differs from the recorded one", self.refused("explain", "a.pcd", "--index", "0"))


if __name__ == "__main__":
    unittest.main()
