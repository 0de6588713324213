# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Untrusted input files: none makes the program block, crash, or replace another file."""

import json
import os
import struct
import unicodedata
import unittest

from cli_support import BOX, CliTest

HEAD = {"recording": 1, "glidar": "0.1.0", "command": {"arguments": ["stream", "builtin:box"], "folder": "."}}
DEEP = 100_000
CAMERA = "optics: {type: pinhole, width: 8, height: 6, fov_deg: 40}\n"


class Pipes(CliTest):
    def setUp(self):
        super().setUp()
        os.mkfifo(os.path.join(self.folder, "pipe"))
        for suffix in ("yaml", "csv", "npy", "json", "glidar.json", "obj", "ply"):
            os.symlink("pipe", os.path.join(self.folder, f"pipe.{suffix}"))

    def test_no_option_blocks_on_a_pipe(self):
        box = ("render", "builtin:box")
        cases = {
            "model": ("render", "pipe.obj"), "scene": ("render", "pipe.yaml"), "sensor": (*box, "--sensor", "pipe.yaml"),
            "trajectory": (*box, "--trajectory", "pipe.csv"), "device": ("render", "/dev/zero"),
            "device as sensor": (*box, "--sensor", "/dev/zero")}
        for name, command in cases.items():
            with self.subTest(name):
                error = self.refused(*command, "-o", "x.pcd")
                self.assertRegex(error, "not a regular file|not a file")
        self.assertIn("not a regular file", self.refused("explain", "pipe.pcd", "--index", "0"))
        self.assertIn("not a regular file",
                      self.refused("stream", "builtin:box", "--lockstep", "ipc://x.socket", "--curve-keys", "pipe"))

    def test_no_referenced_file_blocks_on_a_pipe(self):
        self.write("noise.yaml", "models:\n- {model: builtin:box, materials: {'*': {noise_texture: pipe}}}\n")
        self.write("sensor.yaml", "models: [{model: builtin:box}]\nsensor: pipe.yaml\n")
        self.write("model.yaml", "models: [{model: pipe.ply}]\n")
        self.write("motion.yaml", "models: [{model: builtin:box, motion: {trajectory: pipe.csv}}]\n")
        for name in ("noise", "sensor", "model", "motion"):
            with self.subTest(name):
                self.refused("render", f"{name}.yaml", "-o", "x.pcd")

    def test_pipes_among_the_files_of_a_recording_count_as_changed(self):
        for path in ("pipe", "/dev/zero", "."):
            self.write("r.jsonl", json.dumps({**HEAD, "files": [{"path": path, "hash": "x"}]}) + '\n{"frames": 0}\n')
            self.assertIn(f"{path} has changed", self.succeed("replay", "r.jsonl").stderr)


def progressive_jpeg(side, scans):
    """A black image whose scans are all the same."""
    table = b"\xff\xdb\0\x43\0" + bytes([1] * 64)
    frame = b"\xff\xc2\0\x0b\x08" + struct.pack(">HH", side, side) + b"\x01\x01\x11\0"
    codes = b"".join(b"\xff\xc4\0\x14" + bytes([kind, 1] + [0] * 16) for kind in (0, 0x10))
    return b"\xff\xd8" + table + frame + codes + scans * (b"\xff\xda\0\x08\x01\x01" + bytes(8)) + b"\xff\xd9"


class Images(CliTest):
    def test_the_scans_of_a_jpeg_are_limited_by_its_size(self):
        self.write("a.obj", "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n")
        self.write("a.mtl", "newmtl m\nmap_Kd a.jpg\n")
        for side, scans, after, is_read in ((16, 30, b"", True), (16, 1000, b"", True), (4096, 40, b"", False),
                                            (4096, 3, 100 * b"\xff\xda", True)):
            with self.subTest(side=side, scans=scans):
                with open(os.path.join(self.folder, "a.jpg"), "wb") as file:
                    file.write(progressive_jpeg(side, scans) + after)
                text = self.succeed("info", "a.obj").stdout
                self.assertEqual("a JPEG with too many scans" not in text, is_read, text)
                self.assertEqual("MISSING" not in text, is_read, text)


class Text(CliTest):
    def test_deeply_nested_json_is_refused(self):
        deep = "[" * DEEP + "]" * DEEP
        self.write("r.jsonl", f'{{"recording":{deep}}}\n')
        self.assertIn("r.jsonl:1: JSON nested too deeply", self.refused("replay", "r.jsonl"))
        self.write("a.pcd", "")
        self.write("a.glidar.json", f'{{"glidar":"x","command":null,"frame":{deep}}}')
        self.assertIn("nested too deeply", self.refused("explain", "a.pcd", "--index", "0"))
        self.write("ou.json", f'{{"beam_altitude_angles":{deep}}}')
        self.write("s.yaml", "optics: {type: ouster, file: ou.json}\n")
        self.assertIn("nested too deeply", self.refused("render", "builtin:box", "--sensor", "s.yaml", "-o", "x.pcd"))

    def test_errors_quote_little_of_a_file(self):
        for text in ('{"recording": "' + "x" * 100_000 + '"}', '{"recording": 1, "' + "x" * 100_000, "\x1b[2J" * 10_000,
                     '{"recording": ' + "9" * 100_000 + "}"):
            self.write("r.jsonl", text + "\n")
            error = self.refused("replay", "r.jsonl")
            self.assertLess(len(error), 700)
            self.assertNotIn("\x1b", error)
        self.write("s.yaml", f"name: a\n{'k' * 100_000}: 1\n")
        self.assertLess(len(self.refused("render", "builtin:box", "--sensor", "s.yaml", "-o", "x.pcd")), 1500)

    def test_a_recording_names_paths_without_control_characters(self):
        for change in ({"files": [{"path": "a\0b", "hash": "x"}]}, {"files": [{"path": "", "hash": "x"}]},
                       {"files": [], "command": {"arguments": ["stream", "a\nb"], "folder": "."}},
                       {"files": [], "command": {"arguments": ["stream"], "folder": "a\0"}}):
            self.write("r.jsonl", json.dumps({**HEAD, **change}) + '\n{"frames": 0}\n')
            self.assertIn("without control characters", self.refused("replay", "r.jsonl"))

    def test_names_in_models_do_not_control_the_terminal(self):
        self.write("red.mtl", "newmtl m\x1b[31m\n")
        self.write("red.obj", "mtllib red.mtl\no x\x1b[31m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\x1b[31m\nf 1 2 3\n")
        for command in (("info", "red.obj"), ("render", "red.obj", "--eye", "0.2,0.2,2", "--target", "0.2,0.2,0", "-o", "x.pcd"),
                        ("explain", "x.pcd", "--index", "32896")):
            with self.subTest(command[0]):
                done = self.succeed(*command)
                self.assertNotIn("\x1b", done.stdout + done.stderr)
        self.assertIn("m?[31m", self.succeed("info", "red.obj").stdout)

    HOSTILE = "\x1b]0;TITLE\x07\x1b[31m\x9b2J\u202eevil\u2066\u200b"  # a title, red, erase; order and invisible

    def require_harmless(self, *texts):
        for text in texts:
            found = [character for character in text
                     if character != "\n" and (unicodedata.category(character) in ("Cc", "Cf", "Zl", "Zp", "Cs"))]
            self.assertEqual(found, [], text)

    def run_harmless(self, *command, quotes="evil"):
        """Runs a command that must print `quotes`, from the hostile text, and nothing that controls a terminal."""
        done = self.run_program(*command)
        self.require_harmless(done.stdout, done.stderr)
        self.assertIn(quotes, done.stdout + done.stderr, command)
        return done

    def test_text_of_files_in_errors_notes_and_tables_is_printable(self):
        bad = self.HOSTILE
        quoted = json.dumps(bad)
        self.write("m.mtl", f"newmtl a{bad}\nmap_Kd {bad}.png\n")
        self.write("m.obj", f"mtllib m.mtl\nmtllib {bad}.mtl\no {bad}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a{bad}\nf 1 2 3\n")
        self.write("box.obj", BOX)
        self.write("scene.yaml", f"models:\n  - {{model: box.obj, name: {quoted}, class: {quoted}}}\n")
        self.write("missing.yaml", f"models:\n  - {{model: {quoted}}}\n")
        self.write("key.yaml", f"{quoted}: 1\n")
        self.write("material.yaml", f"models:\n  - {{model: m.obj, materials: {{{quoted}: {{surface: {quoted}}}}}}}\n")
        self.write("sensor.yaml", f"name: {quoted}\nnotes: [{quoted}]\noptics: {{type: pinhole, width: 8, height: 8, fov_deg: 30}}\n")
        self.write("beams.yaml", f"name: t\noptics: {{type: table, file: {quoted}}}\n")
        self.write("rows.yaml", "name: t\noptics: {type: table, file: rows.csv}\n")
        self.write("rows.csv", f"Time/s,Azimuth/deg,Zenith/deg\n{bad},1,2\n")
        self.write("head.yaml", "name: t\noptics: {type: table, file: head.csv}\n")
        self.write("head.csv", f"Time/s,{bad}\n0,1\n")
        self.write("poses.csv", f"{bad}\n")
        self.write("poses.txt", f"0 0 0 0 0 0 0 {bad}\n")
        os.mkdir(os.path.join(self.folder, "bag.rosbag2"))
        self.write("bag.rosbag2/metadata.yaml", "rosbag2_bagfile_information:\n  version: 5\n"
                   f"  storage_identifier: {quoted}\n  relative_file_paths: [{quoted}]\n")
        self.write("r.jsonl", f'{{"recording": {quoted}}}\n')
        self.write("a.pcd", "")
        self.write("a.glidar.json", f'{{{quoted}: {quoted}}}')
        out = ("-w", "4", "--height", "4", "-o", "x.pcd")
        self.run_harmless("render", "m.obj", "--no-cache", *out)
        self.run_harmless("info", "m.obj")
        self.run_harmless("info", "m.obj", "--json")
        for scene in ("missing.yaml", "key.yaml", "material.yaml"):
            self.run_harmless("render", scene, *out)
        self.run_harmless("render", "scene.yaml", *out, quotes="wrote x.pcd")
        self.run_harmless("explain", "x.pcd", "--index", "5")
        sensors = {"beams.yaml": "evil", "rows.yaml": "rows.csv:2: no three numbers",
                   "head.yaml": "head.csv:2: no three numbers", "key.yaml": "evil"}
        for sensor, quotes in sensors.items():
            self.run_harmless("render", "builtin:box", "--sensor", sensor, "-o", "y.pcd", quotes=quotes)
            self.run_harmless("sensors", sensor, quotes=quotes)
            self.run_harmless("sensors", sensor, "--json", quotes=quotes)
        self.run_harmless("render", "builtin:box", "--sensor", "sensor.yaml", "-o", "y.pcd")
        self.run_harmless("sensors", "sensor.yaml")
        self.run_harmless("sensors", "sensor.yaml", "--json")
        self.run_harmless("render", "builtin:box", "--trajectory", "poses.csv", *out, quotes="poses.csv:1:1: 1 columns")
        self.run_harmless("render", "builtin:box", "--trajectory", "poses.txt", *out)
        self.run_harmless("decode", "bag.rosbag2", "-o", "z.pcd")
        self.run_harmless("replay", "r.jsonl")
        self.run_harmless("explain", "a.pcd", "--index", "0", quotes="the key 'glidar' is missing")
        self.run_harmless("render", bad, *out)
        self.run_harmless("render", "builtin:box", bad)
        self.run_harmless("render", "builtin:box", f"--{bad}")
        self.run_harmless("render", "builtin:box", "--sensor", bad, "-o", "x.pcd")

    def test_a_line_end_in_a_name_begins_no_message(self):
        self.write("scene.yaml", 'models:\n  - {model: "a\\nglidar: error: forged"}\n')
        self.assertEqual(self.refused("render", "scene.yaml", "-o", "x.pcd").count("\n"), 1)

    def test_times_beyond_64_bit_nanoseconds_are_refused(self):
        self.write("s.yaml", "optics: {type: table, file: t.csv}\n")
        for time in ("1e12", "9223372036854775807", "-1e12", "8640001"):
            rows = "".join(f"0.0000{i},{i},90\n" for i in range(10, 20))
            self.write("t.csv", "Time/s,Azimuth/deg,Zenith/deg\n" + rows + f"{time},1,90\n")
            error = self.refused("render", "builtin:box", "--sensor", "s.yaml", "-o", "x.pcd")
            self.assertIn("t.csv:12: a time of", error)
            self.assertIn("within 100 days", error)


class Guard(CliTest):
    """No output replaces an input file."""

    def setUp(self):
        super().setUp()
        self.write("box.obj", BOX)

    def kept(self, name, text, *command):
        self.write(name, text)
        self.assertIn("is an input file", self.refused(*command))
        self.assertEqual(self.bytes_of(name).decode(), text)

    def test_sidecars(self):
        self.write("scene.yaml", "models: [{model: box.obj}]\nsensor: q.glidar.json\n")
        self.kept("q.glidar.json", CAMERA, "render", "scene.yaml", "-o", "q.pcd")
        self.write("two.yaml", "models: [{model: box.obj}]\nsensor: q_000001.glidar.json\n")
        self.kept("q_000000.glidar.json", CAMERA, "render", "box.obj", "--sensor", "q_000000.glidar.json", "--duration", "0.05",
                  "--per-frame", "-o", "q.pcd")
        self.kept("q_000000.glidar.json", CAMERA, "stream", "box.obj", "--sensor", "q_000000.glidar.json", "--frames", "1",
                  "-o", "q.pcd")
        self.succeed("render", "scene.yaml", "-o", "q.pcd", "--no-sidecar")

    def test_labels_and_folders_of_kitti(self):
        self.write("scene.yaml", "models: [{model: box.obj, class: box}]\nsensor: q.label\n")
        self.kept("q.label", CAMERA, "render", "scene.yaml", "-o", "q.bin")
        os.makedirs(os.path.join(self.folder, "k.kitti", "calib"))
        self.write("folder.yaml", "models: [{model: box.obj}]\nsensor: k.kitti/calib/000000.txt\n")
        self.kept("k.kitti/calib/000000.txt", CAMERA, "render", "folder.yaml", "-o", "k.kitti")
        self.assertEqual(os.listdir(os.path.join(self.folder, "k.kitti")), ["calib"])

    def test_files_of_the_sensors_of_a_rig(self):
        self.write("rig.yaml", "models: [{model: box.obj}]\nrig_pose: {position: [0, 0, 5]}\n"
                               "sensors: [{name: a, sensor: q_a.glidar.json}, {name: b, sensor: q_a.glidar.json}]\n")
        self.kept("q_a.glidar.json", CAMERA, "render", "rig.yaml", "-o", "q.pcd")

    def test_pictures_statistics_and_recordings(self):
        os.symlink("mine.yaml", os.path.join(self.folder, "mine.png"))
        self.write("mine.yaml", CAMERA)
        done = self.run_program("sensors", "mine.yaml", "-o", "mine.png")
        self.assertEqual(done.returncode, 2)
        self.assertIn("is an input file", done.stderr)
        self.assertTrue(os.path.islink(os.path.join(self.folder, "mine.png")))
        for option in ("--stats", "--record"):
            self.kept("mine.yaml", CAMERA, "stream", "box.obj", "--sensor", "mine.yaml", "--frames", "1", "-o", "x.pcd",
                      option, "mine.yaml")
            done = self.run_program("stream", "box.obj", "--sensor", "mine.yaml", "--frames", "1", "-o", "x.pcd", option,
                                    "x_000000.glidar.json")
            self.assertEqual(done.returncode, 2)
            self.assertIn("x_000000.glidar.json: is an input file", done.stderr)
            self.assertFalse(os.path.exists(os.path.join(self.folder, "x_000000.pcd")))


if __name__ == "__main__":
    unittest.main()
