# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""How model files are read: unit, up axis, centre, and sizes of built-in models."""

import json
import os
import unittest

from cli_support import CliTest


class ModelOptions(CliTest):
    def test_unit_and_up_of_the_file_are_applied_and_reported(self):
        self.write("a.amf", '<?xml version="1.0"?><amf unit="inch"><object id="1"><mesh><vertices>' + "".join(
            f"<vertex><coordinates><x>{x}</x><y>{y}</y><z>{z}</z></coordinates></vertex>"
            for x, y, z in ((0, 0, 0), (100, 0, 0), (0, 200, 0))) +
            "</vertices><volume><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh></object></amf>")
        report = json.loads(self.succeed("info", "a.amf", "--json").stdout)
        self.assertEqual((report["metres_per_unit"], report["unit_declared"]), (0.0254, 0.0254))
        self.assertAlmostEqual(report["size_m"][1], 5.08, places=5)
        self.assertIn("0.0254 m, declared by the file", self.succeed("info", "a.amf").stdout)
        done = self.succeed("render", "a.amf", "-o", "x.pcd")
        self.assertNotIn("--u", done.stderr)  # no hint: the file declares both
        with open(os.path.join(self.folder, "x.glidar.json"), encoding="utf-8") as file:
            instance = json.load(file)["instances"][0]
        self.assertEqual((instance["metres_per_unit"], instance["up"]), (0.0254, "z"))
        report = json.loads(self.succeed("info", "a.amf", "--unit", "m", "--json").stdout)
        self.assertEqual((report["metres_per_unit"], report["unit_declared"]), (1.0, 0.0254))

    def test_texture_folders(self):
        for folder in ("model", "art/images", "art/others"):
            os.makedirs(os.path.join(self.folder, folder))
        self.write("model/a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n")
        self.write("model/a.mtl", "newmtl m\nmap_Kd ../images/a.ppm\nmap_Ks model://skins/others/b.ppm\n")
        for name in ("images/a", "others/b"):
            self.write(f"art/{name}.ppm", "P6 1 1 255\nabc")

        def missing(*options):
            return [t["name"] for t in json.loads(self.succeed("info", "model/a.obj", "--json", *options).stdout)["missing_textures"]]

        self.assertEqual(missing(), ["../images/a.ppm", "model://skins/others/b.ppm"])
        self.assertIn("name its folder with --texture-folder", self.succeed("info", "model/a.obj").stdout)
        self.assertEqual(missing("--texture-folder", "art"), [])
        self.assertEqual(missing("--texture-folder", "art/images"), ["model://skins/others/b.ppm"])
        self.assertEqual(missing("--texture-folder", "art/images", "--texture-folder", "art/others"), [])
        self.assertIn("'gone' is not a folder", self.refused("info", "model/a.obj", "--texture-folder", "gone"))
        camera = "sensor: {optics: {width: 4, height: 3, fov_deg: 30}}\n"
        os.makedirs(os.path.join(self.folder, "scenes"))
        for folders, all_found in (("../art", True), ("[../art/images, ../art/others]", True), ("../art/images", False)):
            self.write("scenes/a.yaml", f"models: [{{model: ../model/a.obj, texture_folder: {folders}}}]\n{camera}")
            done = self.succeed("render", "scenes/a.yaml", "-o", "x.pcd")
            self.assertEqual("textures missing" not in done.stderr, all_found, folders)
        self.write("scenes/a.yaml", f"models: [{{model: ../model/a.obj, texture_folder: ../art}}, {{model: ../model/a.obj}}]\n{camera}")
        self.assertIn("textures missing", self.succeed("render", "scenes/a.yaml", "-o", "x.pcd").stderr)
        self.write("scenes/a.yaml", f"models: [{{model: ../model/a.obj}}]\n{camera}")
        done = self.succeed("render", "scenes/a.yaml", "-o", "x.pcd", "--texture-folder", "art")
        self.assertNotIn("textures missing", done.stderr)
        self.write("scenes/a.yaml", f"models: [{{model: ../model/a.obj, texture_folder: ../gone}}]\n{camera}")
        self.assertIn("a.yaml:1", self.refused("render", "scenes/a.yaml", "-o", "x.pcd"))

    def test_centre_and_sizes(self):
        self.write("far.obj", "v 1000 0 0\nv 1004 0 0\nv 1000 2 0\nf 1 2 3\n")
        report = json.loads(self.succeed("info", "far.obj", "--centre", "--json").stdout)
        self.assertEqual(report["min_m"], [-2.0, -1.0, 0.0])
        report = json.loads(self.succeed("info", "builtin:box:size=4,2,1", "--json").stdout)
        self.assertEqual(report["size_m"], [4.0, 2.0, 1.0])
        self.assertIn("allowed: size", self.refused("info", "builtin:box:radius=4"))

    def test_a_size_given_twice_is_refused(self):
        self.write("twice.yaml", "models: [{model: 'builtin:box:size=3', size: [1, 2, 3]}]\nsensor: VLP-16\n")
        self.assertIn("'size' is given twice", self.refused("render", "twice.yaml", "-o", "x.pcd"))

    def test_no_number_of_a_rotated_model_is_minus_zero(self):
        self.write("flat.obj", "v 0 0 0\nv 4 0 0\nv 0 2 0\nf 1 2 3\n")
        for up in "xyz":
            text = self.succeed("info", "flat.obj", "--up", up).stdout
            self.assertNotRegex(text, r"-0(?![.\d])|-0\.0*(?!\d)", up)
            self.assertNotRegex(self.succeed("info", "flat.obj", "--up", up, "--json").stdout, r"-0\.0[,\]\s]", up)


if __name__ == "__main__":
    unittest.main()
