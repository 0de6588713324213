# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The command line from the user's view. The built program is found in PATH."""

import json
import math
import os
import re
import shlex
import shutil
import signal
import struct
import subprocess
import unittest
import zipfile

from cli_support import BOX, MAX_WAIT_S, CliTest, box_of, free_ports
from waiting import wait_until


class Help(CliTest):
    def test_version(self):
        self.assertRegex(self.succeed("--version").stdout, 
                         r"^glidar \d+\.\d+\.\d+\noptional parts: (none|(window|Foxglove server|sensor control \(HTTP, PTC\)|ROS 2 \(DDS\)|OpenEXR|, )+)\n$")

    def test_examples_of_every_help_run(self):
        lines = []
        for level in ([], ["render"], ["explain"], ["view"], ["stream"], ["info"], ["sensors"],
                      ["depth", "stereo"], ["depth", "tof"], ["depth"], ["verify"]):
            text = self.succeed(*level, "--help").stdout
            own = text[text.index("Examples:"):].split("With your own files:")[0]
            lines += re.findall(r"(?m)^  (glidar .*)$", own)
        self.assertGreaterEqual(len(lines), 10)
        for line in dict.fromkeys(lines):  # several pages have the same example
            with self.subTest(line):
                self.run_example(shlex.split(line)[1:])

    def run_example(self, arguments):
        """Runs for one frame: windows on a virtual display, streams without waiting for subscribers."""
        if arguments[0] == "stream":
            self.run_stream(arguments)
        elif arguments[0] == "verify":
            self.verify(*arguments[1:])
        elif arguments[0] != "view":
            self.succeed(*arguments)
        elif shutil.which("xvfb-run"):
            done = subprocess.run(["xvfb-run", "-a", "glidar", *arguments, "--frames", "1"],
                                  cwd=self.folder, env=self.environment, capture_output=True,
                                  text=True, timeout=MAX_WAIT_S, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)

    def run_stream(self, arguments):
        port = str(free_ports())
        arguments = [{"5555": port, "8765": "0"}.get(word, word) for word in arguments]
        if "--subscribers" not in arguments:
            arguments += ["--subscribers", "0"]
        self.succeed(*arguments, "--frames", "1")

    def test_help_has_one_line_of_at_most_100_characters_per_option(self):
        for level in ("render", "view", "stream", "replay", "decode", "info", "depth filter",
                      "depth stereo", "depth tof", "verify"):
            text = self.succeed(*level.split(), "--help").stdout
            self.assertNotRegex(text, r"[{}]|INT|FLOAT|TEXT|REQUIRED")
            self.assertLessEqual(max(len(line) for line in text.split("\n")), 100)
            self.assertNotRegex(text, r"(?m)^ {20}", "an option takes a second line")
            options = re.findall(r"(?m)^  -.*$", text)
            self.assertGreaterEqual(len(options), 4)
            for option in options:
                self.assertRegex(option, r"^  -\S+( \S+)?  +[A-Za-z0-9]")

    def test_h_is_help_and_all_formats_are_listed(self):
        text = self.succeed("render", "-h").stdout
        for suffix in (".pcd", ".ply", ".npz", ".csv", ".bin", ".npy", ".depth.png", ".transform"):
            self.assertIn(suffix, text)


class Words(CliTest):
    """Words that people know from other programs."""

    def test_help_of_a_subcommand_is_its_help(self):
        self.assertEqual(self.succeed("help", "info").stdout, self.succeed("info", "--help").stdout)
        self.assertEqual(self.succeed("help").stdout, self.succeed("--help").stdout)
        for words in ([], ["stereo"], ["stereo", "output"]):
            self.assertEqual(self.succeed("help", "depth", *words).stdout, self.succeed("depth", *words[:1], "--help", *words[1:]).stdout)
        self.assertIn("did you mean --version?", self.refused("version"))

    def test_tools_without_their_subcommand_are_named(self):
        self.assertIn("'tof' is a tool of 'depth': glidar depth tof", self.refused("tof", "builtin:disc"))
        self.assertIn("'sterio' is no tool; did you mean stereo?", self.refused("depth", "sterio"))
        self.assertIn("'x' is no tool; allowed: filter, align, stereo, structured-light, tof", self.refused("depth", "x"))
        self.assertIn("a tool is required; see glidar depth --help", self.refused("depth"))
        self.assertIn("unknown option --cencus; did you mean --census?", self.refused("depth", "stereo", "builtin:dots", "--cencus", "9x9"))

    def test_help_of_a_section_lists_its_options_only(self):
        text = self.succeed("help", "render", "fisher").stdout
        self.assertEqual(text, self.succeed("render", "--help", "Fisher").stdout)
        self.assertIn("--range-sigma M", text)
        self.assertNotIn("--sensor", text)
        for words in (("help", "render", "nothing"), ("render", "--help", "model.obj"), ("render", "a.obj", "--help", "b.obj")):
            self.assertEqual(self.succeed(*words).stdout, self.succeed("render", "--help").stdout, words)
        self.assertIn("'nothing' is no subcommand", self.refused("help", "nothing"))

    def test_joined_short_options_are_recorded_as_the_same_command(self):
        for words in (("-qo", "a.pcd"), ("-qj", "2", "-o", "a.pcd"), ("-qqj2", "-oa.pcd"), ("-o", "a.pcd")):
            self.succeed("render", "builtin:box", *words)
            command = json.loads(self.bytes_of("a.glidar.json"))["command"]["arguments"]
            self.assertEqual(command, ["render", "builtin:box", "-o", "a.pcd"], words)
            self.succeed("explain", "a.pcd", "--index", "3")

    def test_words_after_two_hyphens_stay_as_they_are(self):
        self.assertIn("--color-by.obj", self.refused("render", "-o", "a.pcd", "--", "--color-by.obj"))

    def test_completions_know_commands_options_and_presets(self):
        self.write("glidar.bash", self.succeed("completion", "bash").stdout)
        for words, expected in ((["st"], "stream"), (["depth", "st"], "stereo structured-light"),
                                (["depth", "stereo", "--cen"], "--census"), (["render", "--col"], "--columns --colour-by --columns-per-turn"),
                                (["render", "--sensor", "VLP-1"], "VLP-16"), (["help", "sch"], "schema")):
            script = f"source glidar.bash; COMP_WORDS=(glidar {' '.join(words)}); COMP_CWORD={len(words)}; _glidar; echo ${{COMPREPLY[@]}}"
            done = subprocess.run(["bash", "-c", script], cwd=self.folder, capture_output=True, text=True, check=True)
            self.assertEqual(done.stdout.strip(), expected)

    def test_other_shells_accept_their_completions_and_groff_the_manual_page(self):
        for kind, program in (("zsh", ["zsh", "-n"]), ("fish", ["fish", "-n"]), ("man", ["groff", "-man", "-ww", "-z"])):
            self.write(f"glidar.{kind}", self.succeed("completion", kind).stdout)
            if shutil.which(program[0]):
                done = subprocess.run([*program, f"glidar.{kind}"], cwd=self.folder, capture_output=True, text=True, check=False)
                self.assertEqual((done.returncode, done.stderr), (0, ""), kind)

    def test_h_with_a_number_is_not_the_height(self):
        self.assertIn("--height 480", self.refused("render", "builtin:box", "-w", "640", "-h", "480", "-o", "a.pcd"))

    def test_american_spellings_capitals_and_feet_are_accepted(self):
        self.write("box.obj", BOX)
        self.succeed("render", "box.obj", "--up", "Y", "--unit", "FT", "--center", "--color-by=range", "-o", "a.view.png")
        self.succeed("render", "box.obj", "--up", "y", "--unit", "ft", "--centre", "--colour-by", "range", "-o", "b.view.png")
        self.assertEqual(self.bytes_of("a.view.png"), self.bytes_of("b.view.png"))

    def test_unknown_options_of_other_programs_name_ours(self):
        for word, option in (("--pose", "--sensor-pose"), ("--frames", "--duration"), ("--fps", "--rate")):
            self.assertIn(f"did you mean {option}?", self.refused("render", "builtin:box", word, "1", "-o", "a.pcd"))


class Render(CliTest):
    def test_implausible_numbers_of_a_sensor_are_warned_of_also_when_quiet(self):
        self.write("s.yaml", "optics: {type: spinning, columns_per_turn: 90, elevation_deg: [-0.2, 0.2]}\n")
        done = self.succeed("render", "builtin:box", "--sensor", "s.yaml", "--quiet", "-o", "a.pcd")
        self.assertIn("optics.elevation_deg: from -0.2 to 0.2; usual: at least 1 between them; are these radians?", done.stderr)

    def test_arrays_of_a_lidar_are_its_ranges(self):
        self.succeed("render", "builtin:box", "--sensor", "VLP-16", "-o", "a.npy", "-o", "a.range.npy", "-o", "a.range.png")
        self.assertEqual(self.bytes_of("a.npy"), self.bytes_of("a.range.npy"))
        files = json.loads(self.bytes_of("a.glidar.json"))["files"]
        self.assertEqual([one["file"] for one in files], ["a.npy", "a.range.npy", "a.range.png"])
        for one in files:
            self.assertTrue(one["image"]["pixels"].startswith("range along the beam"), one)

    def test_summary_and_files(self):
        done = self.succeed("render", "builtin:box", "-w", "40", "--height", "30",
                            "-o", "a.pcd", "-o", "b.ply", "-o", "c.png")
        self.assertRegex(done.stdout, r"30 x 40 beams, \d+ hits \(\d+\.\d %\), range [\d.]+ to [\d.]+ m")
        self.assertIn("wrote a.pcd b.ply c.png", done.stdout)
        self.assertEqual(done.stderr, "")
        self.assertEqual(self.files(), ["a.glidar.json", "a.pcd", "b.glidar.json", "b.ply", "c.png"])

    def test_quiet_and_no_sidecar(self):
        done = self.succeed("render", "builtin:box", "-o", "a.pcd", "--quiet", "--no-sidecar")
        self.assertEqual((done.stdout, done.stderr), ("", ""))
        self.assertEqual(self.files(), ["a.pcd"])

    def test_auto_framed_model_fills_the_view_and_is_not_cut_off(self):
        for size in (("64", "64"), ("200", "20"), ("20", "200")):
            self.succeed("render", "builtin:box", "-w", size[0], "--height", size[1],
                         "-o", "a.csv", "--columns", "xyz,row,col,status")
            with open(os.path.join(self.folder, "a.csv"), encoding="utf-8") as file:
                lines = [line for line in file.read().split("\n") if line and line[0] != "#"]
            names = lines[0].split(",")
            rows, cols = [], []
            for line in lines[1:]:
                point = dict(zip(names, line.split(",")))
                if not math.isnan(float(point["x"])):
                    rows.append(int(point["row"]))
                    cols.append(int(point["col"]))
            width, height = int(size[0]), int(size[1])
            self.assertGreater(min(rows + cols), 0 if min(width, height) > 40 else -1)
            self.assertLess(max(cols), width)
            filled = max((max(cols) - min(cols) + 1) / width, (max(rows) - min(rows) + 1) / height)
            self.assertGreater(filled, 0.85)

    def test_same_bytes_for_any_number_of_threads_with_and_without_cache(self):
        names = ("a.pcd", "a.ply", "a.npz")
        self.write("box.obj", BOX)
        contents = {}
        for name, arguments in (("1 thread", ("--threads", "1", "--no-cache")),
                                ("2 threads", ("--threads", "2", "--no-cache")),
                                ("fills the cache", ("--threads", "1")),
                                ("from the cache", ("--threads", "2"))):
            outputs = [word for output in names for word in ("-o", output)]
            self.succeed("render", "box.obj", "-w", "301", "--height", "203", *arguments,
                         "--columns", "all", *outputs)
            contents[name] = [self.bytes_of(output) for output in names]
            self.assertEqual(contents[name], contents["1 thread"], name)
        self.assertIn("(from the cache)", self.succeed("info", "box.obj").stdout)

    def test_npz_has_no_timestamps(self):
        self.succeed("render", "builtin:box", "-o", "a.npz")
        with zipfile.ZipFile(os.path.join(self.folder, "a.npz")) as archive:
            self.assertGreater(len(archive.infolist()), 5)
            for entry in archive.infolist():
                self.assertEqual(entry.date_time, (1980, 1, 1, 0, 0, 0), entry.filename)
                self.assertEqual(entry.extra, b"", entry.filename)

    def test_concurrent_runs_with_the_same_output_leave_a_complete_file(self):
        command = ["glidar", "render", "builtin:box", "--quiet", "-o", "same.pcd"]
        runs = [subprocess.Popen(command, cwd=self.folder, env=self.environment) for _ in range(4)]
        self.assertEqual([run.wait(timeout=MAX_WAIT_S) for run in runs], [0] * len(runs))
        self.assertEqual(self.files(), ["same.glidar.json", "same.pcd"])
        together = self.bytes_of("same.pcd")
        self.succeed(*command[1:])
        self.assertEqual(self.bytes_of("same.pcd"), together)

    def test_same_bytes_with_and_without_the_cache(self):
        self.write("paint.ppm", "P6 2 2 255\na c!e~ghijkl")
        self.write("paint.mtl", "newmtl paint\nKs 1 1 1\nNs 9\nmap_Kd paint.ppm\nmap_bump paint.ppm\n")
        corners = re.sub(r"(?m)^v (\S+)", lambda m: f"v {float(m.group(1)) + 123456.7}", BOX)
        faces = re.sub(r"(?m)^f (\d) (\d) (\d) (\d)", r"f \1/1 \2/2 \3/3 \4/4", corners)
        self.write("box.obj", "mtllib paint.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl paint\n" + faces)
        contents = []
        for arguments in (("--no-cache",), ("--no-cache",), (), (), ("--cache-folder", "other")):
            self.succeed("render", "box.obj", *arguments, "--columns", "all", "-o", "a.npz")
            with open(os.path.join(self.folder, "a.npz"), "rb") as file:
                contents.append(file.read())
        self.assertIn('"from_cache": true', self.succeed("info", "box.obj", "--json").stdout)
        self.assertEqual(set(contents), {contents[0]})

    def read_legacy(self, name):
        with open(os.path.join(self.folder, name + ".pcd"), "rb") as file:
            head, body = file.read().split(b"DATA binary\n", 1)
        with open(os.path.join(self.folder, name + ".transform"), encoding="utf-8") as file:
            rows = [[float(x) for x in line.split()] for line in file if line.strip()]
        points = [struct.unpack_from("<4f", body, i) for i in range(0, len(body), 16)]
        return head.decode(), points, rows

    def test_legacy_output_matches_the_model(self):
        self.succeed("render", "builtin:box", "--model-r", "0.4,1,2,3", "--camera-r",
                     "0.1,-0.2,0.5,0.7", "--camera-z", "9", "--fov", "60", "--legacy-output", "view")
        self.assertEqual(self.files(), ["view.pcd", "view.transform"])
        head, points, rows = self.read_legacy("view")
        self.assertIn("FIELDS x y z intensity\n", head)
        self.assertIn("HEIGHT 1\n", head)
        self.assertGreater(len(points), 1000)
        self.assertEqual(len(rows), 4)
        # the saved transform moves every point to the surface of the 2 m box
        for x, y, z, _ in points:
            p = [x - rows[0][3], y - rows[1][3], z - rows[2][3]]
            back = [abs(sum(rows[k][i] * p[k] for k in range(3))) for i in range(3)]
            self.assertAlmostEqual(max(back), 1.0, delta=1e-5)

    def test_legacy_output_has_x_left(self):
        # the object's +x is at the left, +y up, +z away: a corner cut off by moving the model
        self.write("three.obj", "v 1 0 0\nv 1 0.2 0\nv 1 0 0.2\nv 1.2 0.1 0\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 1 3 2\n")
        self.succeed("render", "three.obj", "--camera-z", "10", "--fov", "30", "--legacy-output", "view")
        _, points, rows = self.read_legacy("view")
        self.assertTrue(points)
        for x, y, z, _ in points:
            self.assertTrue(0.99 < x < 1.21 and -0.01 < y < 0.21 and 9.99 < z < 10.21, (x, y, z))
        self.assertEqual([row[3] for row in rows], [0.0, 0.0, 10.0, 1.0])

    def test_cloud_frames_are_named_in_the_files(self):
        for frame, name in (("optical", "optical"), ("ros", "camera_frame"), ("gl", "gl"),
                            ("world", "world"), ("legacy", "legacy")):
            self.succeed("render", "builtin:box", "--frame", frame, "-o", "a.pcd")
            with open(os.path.join(self.folder, "a.glidar.json"), encoding="utf-8") as file:
                self.assertIn(name, json.dumps(json.load(file)))

    def test_world_cloud_is_on_the_model(self):
        self.succeed("render", "builtin:box", "--frame", "world", "--drop-invalid", "-o", "a.csv",
                     "--columns", "xyz")
        with open(os.path.join(self.folder, "a.csv"), encoding="utf-8") as file:
            lines = [line for line in file.read().split("\n") if line and line[0] != "#"]
        for line in lines[1:]:
            self.assertAlmostEqual(max(abs(float(x)) for x in line.split(",")[:3]), 1.0, delta=1e-5)

    def test_wide_views_are_framed_from_outside_the_model(self):
        for fov in ("100", "150", "179"):
            done = self.succeed("render", "builtin:box", "--fov", fov, "-o", "x.pcd")
            self.assertEqual(done.stderr, "", fov)

    def test_models_on_the_plane_y_0_get_a_hint_at_up(self):
        standing = re.sub(r"(?m)^v (\S+) -1 ", r"v \1 0 ", BOX)  # y from 0 to 1
        self.write("y.obj", standing)
        self.assertIn("a guess", self.succeed("info", "y.obj").stdout)
        self.assertIn("--up y", self.succeed("render", "y.obj", "-o", "x.pcd").stderr)
        self.assertNotIn("warning", self.succeed("render", "y.obj", "-o", "x.pcd").stderr)
        for arguments in (("--up", "y"), ("--eye", "5,5,5"), ("--quiet",)):
            done = self.succeed("render", "y.obj", "-o", "x.pcd", *arguments)
            self.assertEqual(done.stderr, "", arguments)
        self.write("both.obj", BOX)
        self.assertNotIn("--up", self.succeed("info", "both.obj").stdout)

    def test_unit_and_up(self):
        self.write("box.obj", box_of(2000))
        text = self.succeed("info", "box.obj", "--unit", "mm", "--json").stdout
        self.assertEqual(json.loads(text)["size_m"], [2.0, 2.0, 2.0])
        done = self.succeed("render", "box.obj", "--unit", "mm", "--up", "y", "-o", "x.pcd")
        self.assertEqual(done.stderr, "")


class Motion(CliTest):
    def test_fisher_information_is_written_beside_the_output(self):
        reported = self.succeed("render", "builtin:plane", "--eye", "0,0,5", "--target", "0,0,0",
                            "--up-vector", "0,1,0", "--fisher", "-o", "view.pcd").stdout
        self.assertIn("sigma of ranges assumed: 0.01 m", reported)
        self.assertIn("DEGENERATE   translation along x", reported)
        with open(os.path.join(self.folder, "view.fisher.json"), encoding="utf-8") as file:
            information = json.load(file)
        self.assertEqual(sum(d["degenerate"] for d in information["directions"]), 3)
        self.assertIn("give --fisher too", self.refused(
            "render", "builtin:box", "--range-sigma", "0.1", "-o", "x.pcd"))

    def test_a_run_starts_with_its_trajectory(self):
        self.write("path.tum", "0 0 0 -7 0 0 0 1\n1 0 0 -6 0 0 0 1\n")
        self.succeed("render", "builtin:box", "--trajectory", "path.tum", "-o", "x.pcd")
        with open(os.path.join(self.folder, "x.glidar.json"), encoding="utf-8") as file:
            pose = json.load(file)["world_from_sensor"]
        self.assertEqual(pose["position_m"], [0, 0, -7])
        late = self.write("late.tum", "5 0 0 -6 0 0 0 1\n")
        self.succeed("render", "builtin:box", "--trajectory", late, "-o", "late.pcd")
        with open(os.path.join(self.folder, "late.glidar.json"), encoding="utf-8") as file:
            written = json.load(file)
        self.assertEqual((written["stamp_ns"], written["world_from_sensor"]["position_m"]), (5 * 10**9, [0, 0, -6]))
        self.assertIn("its first or last pose is used", self.warned("builtin:box", "--trajectory", late, "--duration", "1"))
        self.assertIn("both are given; give one of them", self.refused(
            "render", "builtin:box", "--trajectory", "path.tum", "--camera-z", "5", "-o", "y.pcd"))


class SceneFiles(CliTest):
    SCENE = """models:
  - {model: builtin:box, name: left, pose: {position: [-3, 0, 0]}, id: 7}
  - {model: builtin:sphere, name: right, pose: {position: [3, 0, 0]}, id: 9}
sensor:
  optics: {type: pinhole, width: 60, height: 20, fov_deg: 30}
sensor_pose:
  look_at: {eye: [0, -20, 0], target: [0, 0, 0]}
"""

    def ids(self, *arguments):
        self.write("scene.yaml", self.SCENE)
        done = self.succeed("render", "scene.yaml", *arguments, "--drop-invalid", "--columns", "xyz,instance",
                            "-o", "a.csv")
        with open(os.path.join(self.folder, "a.csv"), encoding="utf-8") as file:
            lines = [line for line in file.read().split("\n") if line and line[0] != "#"]
        return {line.split(",")[3] for line in lines[1:]}, done.stdout

    def test_sensor_and_pose_of_the_file_are_used(self):
        ids, summary = self.ids()
        self.assertEqual(ids, {"7", "9"})
        self.assertIn("20 x 60 beams", summary)

    def test_options_override_the_file(self):
        ids, summary = self.ids("-w", "30", "--height", "40", "--eye", "-3,-8,0", "--target", "-3,0,0")
        self.assertEqual(ids, {"7"})
        self.assertIn("40 x 30 beams", summary)

    def test_sensor_file_overrides_the_scene_file(self):
        self.write("sensor.yaml", "optics: {type: pinhole, width: 33, height: 11, fov_deg: 30}\n")
        self.assertIn("11 x 33 beams", self.ids("--sensor", "sensor.yaml")[1])
        self.assertIn("both are given; give one of them",
                      self.refused("render", "scene.yaml", "--sensor", "sensor.yaml", "--fov", "9",
                                   "-o", "x.pcd"))

    def test_options_for_one_model_are_refused(self):
        self.write("scene.yaml", self.SCENE)
        self.assertIn("2 objects", self.refused("render", "scene.yaml", "--scale", "2", "-o", "x.pcd"))


class Advice(CliTest):
    def test_no_hits_are_explained(self):
        for arguments, text in (
                (("--sensor-pose", "0,0,5,1,0,0,0"), "behind the sensor"),
                (("--eye", "5,0,0", "--target", "5,9,0"), "outside the view"),
                (("--far", "1"), "depth limits"),
                (("--near", "100"), "depth limits"),
                (("--eye", "50000,0,0"), "too small"),
                (("--eye", "0.1,0,0", "--target", "1,0,0", "--cull-back-faces"), "--cull-back-faces")):
            with self.subTest(arguments):
                text_found = self.warned("builtin:box", *arguments)
                self.assertIn("nothing was measured", text_found)
                self.assertIn(text, text_found)

    def test_sensor_inside_the_model(self):
        self.assertIn("inside 'box' and sees the backs",
                      self.warned("builtin:box", "--eye", "0.1,0,0", "--target", "1,0,0"))

    def test_a_sensor_inside_a_room_gets_no_advice(self):
        def reported(*arguments):
            return self.succeed("render", *arguments, "-o", "x.pcd").stderr
        ahead = ("--target", "1,0,0")
        self.assertEqual(reported("builtin:torus", "--eye", "0,0,0", *ahead), "")  # sees front faces
        for place in ("0,0,0", "0.2,0.1,0"):  # a room with outward triangles, seen by a 360 degree sensor
            self.assertEqual(reported("builtin:box", "--sensor", "VLP-16", "--eye", place), "")
        room = self.write("room.obj", re.sub(r"(?m)^f (\d) (\d) (\d) (\d)$", r"f \4 \3 \2 \1", box_of(4)))
        self.assertEqual(reported(room, "--eye", "0.1,0,0", *ahead), "")

    def test_models_a_thousand_times_too_large_or_small_get_advice(self):
        big = self.write("big.obj", box_of(2000))
        self.assertIn("--unit mm", self.warned(big))
        self.assertNotIn("warning", self.succeed("render", big, "--unit", "m", "-o", "x.npz").stderr)
        small = self.write("small.obj", box_of(0.0004))
        self.assertIn("--scale 1000", self.warned(small))

    def test_models_far_too_large_for_their_distance_get_advice(self):
        ground = self.write("ground.obj", "v -400 -400 0\nv 400 -400 0\nv 400 400 0\nv -400 400 0\n"
                            "f 1 2 3\nf 1 3 4\n")
        self.assertIn("--unit mm", self.warned(ground, "--eye", "0,0,0.3", "--up-vector", "0,1,0"))


class Info(CliTest):
    def test_table_and_json_agree(self):
        table = self.succeed("info", "builtin:torus").stdout
        report = json.loads(self.succeed("info", "builtin:torus", "--json").stdout)
        self.assertIn(f"triangles      {report['triangles']}\n", table)
        self.assertIn("closed, winding outward", table)
        self.assertTrue(report["closed"])
        self.assertEqual(report["winding"], "outward")

    def test_defects_and_missing_textures_are_reported(self):
        self.write("a.mtl", "newmtl red\nKd 1 0 0\nmap_Kd gone.png\n")
        self.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                   "usemtl red\nf 1/1 2/2 3/3\n")
        table = self.succeed("info", "a.obj").stdout
        self.assertIn("gone.png", table)
        self.assertIn("3 open edges", table)
        report = json.loads(self.succeed("info", "a.obj", "--json").stdout)
        self.assertEqual([t["name"] for t in report["missing_textures"]], ["gone.png"])


class Verify(CliTest):
    def test_json_holds_every_shape_and_distance(self):
        report = json.loads(self.verify("--threads", "1", "--json").stdout)
        self.assertTrue(report["passed"])
        self.assertEqual(report["bounds"]["range_ulp"], 0.001)
        rows = [row for row in report["rows"] if row["case"] == "one shape at rest"]
        self.assertEqual(len({row["shape"] for row in rows}), 5)
        self.assertEqual(sorted({row["distance_m"] for row in rows}),
                         [0.1, 1.0, 10.0, 100.0, 1000.0, 10000.0])
        self.assertTrue(all(row["max_range_error_ulp"] <= 0.001 for row in rows))
        self.assertTrue(all(row["compared_hits"] > 1000 and row["wrong_ids"] == 0 for row in rows))

    def test_known_failures_are_listed_with_reasons_and_are_not_errors(self):
        done = self.verify()
        known = re.findall(r"(?m)^known failure: (.*)$", done.stdout)
        self.assertGreater(len(known), 0)
        for line in known:
            self.assertRegex(line, r"m: \d+ wrong hits, \d+ wrong misses, \d+ wrong ids of \d+ rays, "
                                   r"range error \S+ ulp; \w+")
        self.assertRegex(done.stdout, rf"{len(known)} known failures, 0 fixed")

    def test_a_camera_only_renderer_lists_the_cases_that_do_not_apply(self):
        done = self.verify("--renderer", "raster")
        self.assertRegex(done.stdout, r"moving sensor and target +box +10 +not applicable: ")
        self.assertRegex(done.stdout, r"several instances +all +100000 .* passed")

    def test_unknown_renderer(self):
        self.assertIn("rays", self.refused("verify", "--renderer", "magic"))


class Interrupt(CliTest):
    def written_by(self, pid):
        """The open files of a process in the test's folder, also those without a name yet."""
        folder, links = os.path.realpath(self.folder) + "/", []
        for descriptor in os.listdir(f"/proc/{pid}/fd"):
            try:
                links.append(os.readlink(f"/proc/{pid}/fd/{descriptor}"))
            except FileNotFoundError:  # closed meanwhile
                continue
        return [link for link in links if link.startswith(folder)]

    def test_ctrl_c_leaves_no_files(self):
        with subprocess.Popen(
                ["glidar", "render", "builtin:asteroid", "-w", "1200", "--height", "1200",
                 "--columns", "all", "-o", "a.csv", "-o", "b.csv"],
                cwd=self.folder, env=self.environment, stdout=subprocess.PIPE,
                stderr=subprocess.PIPE, text=True) as program:
            wait_until(lambda: self.written_by(program.pid), "it was writing", program, pause_s=0.002)
            self.assertIsNone(program.poll(), "the program ended before it could be interrupted")
            program.send_signal(signal.SIGINT)
            _, error = program.communicate(timeout=MAX_WAIT_S)
        self.assertEqual(program.returncode, 130, error)
        self.assertIn("interrupted", error)
        self.assertEqual(self.files(), [])


if __name__ == "__main__":
    unittest.main()
