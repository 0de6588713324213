# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Names in scenes, models and sensors that look like terminal codes, lines, paths or formulas, in every output format."""

import io
import json
import os
import tempfile
import unittest
import zipfile

import numpy as np
from cli_support import BOX, CliTest

NAMES = {"terminal": "a\x1b[31mb", "line": "a\nb", "path": "../../outside", "absolute": "/tmp/outside", "formula": "=cmd()",
         "columns": "a b\tc"}
CLOUDS = ("csv", "pcd", "ply", "npz", "las", "bin", "exr", "bev.png", "view.png", "mcap")
IMAGES = ("png", "npy", "depth.png", "depth.tiff", "rgb.png", "normal.png", "instance.png", "class.png")
FOLDERS = ("kitti", "rosbag2", "osi")
CAMERA = "optics: {type: pinhole, width: 8, height: 6, fov_deg: 40}\n"


class HostileNames(CliTest):
    def write_scene(self, name):
        """A model, class, material and sensor of this name. OBJ has no names with line ends."""
        quoted = json.dumps(name)
        line = name.replace("\n", " ")
        self.write("m.mtl", f"newmtl {line}\nKd 1 0 0\n")
        self.write("m.obj", BOX.replace("o box", f"mtllib m.mtl\no {line}\nusemtl {line}"))
        self.write("sensor.yaml", f"name: {quoted}\n{CAMERA}")
        self.write("scene.yaml", f"models: [{{model: m.obj, name: {quoted}, class: {quoted}}}]\nsensor: sensor.yaml\n"
                                 "sensor_pose: {position: [0, 0, -5]}\n")

    def all_files(self):
        return {os.path.relpath(os.path.join(folder, file), self.folder)
                for folder, _, names in os.walk(self.folder) for file in names}

    def render(self, suffix):
        """What the output wrote into a folder of its own, by the name of the file."""
        out = os.path.relpath(tempfile.mkdtemp(dir=self.folder), self.folder)
        before = self.all_files()
        done = self.run_program("render", "scene.yaml", "--no-cache", "-o", f"{out}/x.{suffix}")
        self.assertNotIn("\x1b", done.stdout + done.stderr)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "..", "outside")))
        self.assertFalse(os.path.exists("/tmp/outside"))
        new = self.all_files() - before
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(new and all(file.startswith(f"{out}/x.") for file in new), new)
        return {os.path.relpath(file, out): self.bytes_of(file) for file in new}

    def test_no_output_format_lets_a_name_become_a_path_or_a_terminal_code(self):
        for kind, name in NAMES.items():
            self.write_scene(name)
            for suffix in CLOUDS + IMAGES + FOLDERS:
                with self.subTest(kind, suffix=suffix):
                    for file, data in self.render(suffix).items():
                        self.assertTrue(file.isprintable(), file)
                        if file.endswith((".json", ".csv", ".txt", ".yaml", ".label")):
                            self.assertNotIn(b"\x1b", data, file)

    def test_headers_have_the_same_lines_whatever_the_names(self):
        self.write_scene("plain")
        plain = {suffix: self.render(suffix) for suffix in ("csv", "pcd", "ply")}
        for kind, name in NAMES.items():
            self.write_scene(name)
            for suffix, expected in plain.items():
                with self.subTest(kind, suffix=suffix):
                    file = f"x.{suffix}"
                    found = self.render(suffix)
                    self.assertEqual(found[file].split(b"\n")[0], expected[file].split(b"\n")[0])
                    self.assertEqual(found[file].count(b"\n"), expected[file].count(b"\n"))
                    self.assertNotIn(b"=cmd()", found[file])

    def test_labels_of_kitti_have_the_same_columns_whatever_the_names(self):
        self.write_scene("plain")
        plain = self.render("kitti")["x.kitti/label_2/000000.txt"]
        for kind, name in NAMES.items():
            with self.subTest(kind):
                self.write_scene(name)
                found = self.render("kitti")["x.kitti/label_2/000000.txt"]
                self.assertEqual(found.split()[1:], plain.split()[1:])
                self.assertEqual(found.count(b"\n"), 1)

    def test_members_of_archives_have_the_same_names_whatever_the_names(self):
        self.write_scene("plain")
        members = zipfile.ZipFile(io.BytesIO(self.render("npz")["x.npz"])).namelist()
        for kind, name in NAMES.items():
            with self.subTest(kind):
                self.write_scene(name)
                data = self.render("npz")["x.npz"]
                self.assertEqual(zipfile.ZipFile(io.BytesIO(data)).namelist(), members)
                np.load(io.BytesIO(data), allow_pickle=False)

    def test_sidecars_keep_the_exact_names(self):
        for kind, name in NAMES.items():
            with self.subTest(kind):
                self.write_scene(name)
                text = self.render("pcd")["x.glidar.json"].decode("ascii")
                self.assertIn(json.dumps(name), text)

    def test_names_of_rig_sensors_that_are_no_file_names_are_refused(self):
        self.write("box.obj", BOX)
        self.write("sensor.yaml", CAMERA)
        for kind, name in NAMES.items():
            with self.subTest(kind):
                self.write("rig.yaml", "models: [{model: box.obj}]\nrig_pose: {position: [0, 0, -5]}\n"
                                       f"sensors: [{{name: {json.dumps(name)}, sensor: sensor.yaml}}, "
                                       "{name: b, sensor: sensor.yaml}]\n")
                before = self.all_files()
                self.refused("render", "rig.yaml", "-o", "x.pcd")
                self.assertEqual(self.all_files(), before)


if __name__ == "__main__":
    unittest.main()
