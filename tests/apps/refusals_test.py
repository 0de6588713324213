# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Errors of the command line for bad input. The built program is found in PATH."""

import os
import resource
import subprocess
import unittest

from cli_support import BOX, CliTest, free_ports


class Refusals(CliTest):
    def test_unknown_words_suggest_the_closest(self):
        self.assertIn("did you mean --camera-z?",
                      self.refused("render", "builtin:box", "--camra-z", "5", "-o", "x.pcd"))
        self.assertIn("unknown option --port",
                      self.refused("render", "builtin:box", "--port=99", "-o", "x.pcd"))
        self.assertIn("did you mean render?", self.refused("rendr", "builtin:box"))
        self.assertIn("glidar render bunny.ply -o", self.refused("bunny.ply", "--legacy-output", "x"))
        self.assertIn("unexpected word 'b'", self.refused("render", "a", "b", "-o", "x.pcd"))
        self.assertIn("did you mean 'builtin:box'?",
                      self.refused("render", "builtin:bx", "-o", "x.pcd"))

    def test_missing_things(self):
        self.assertIn("nofile.ply", self.refused("render", "nofile.ply", "-o", "x.pcd"))
        self.assertIn("nofile.yaml", self.refused("render", "nofile.yaml", "-o", "x.pcd"))
        self.assertIn("nofile.yaml",
                      self.refused("render", "builtin:box", "--sensor", "nofile.yaml", "-o", "x.pcd"))
        self.assertIn("nofile.ply", self.refused("info", "nofile.ply"))
        self.assertIn("MODEL is required", self.refused("render"))
        self.refused()

    def test_outputs_are_checked_before_anything_is_loaded(self):
        error = self.refused("render", "nofile.ply", "-o", "x.pdc")
        self.assertIn("did you mean .pcd?", error)
        self.assertNotIn("nofile.ply", error)
        self.assertIn("no folder", self.refused("render", "builtin:box", "-o", "no/such/x.pcd"))
        self.assertIn("-o cloud.pcd", self.refused("render", "builtin:box"))
        self.assertIn("given twice", self.refused("render", "builtin:box", "-o", "a.pcd", "-o", "./a.pcd"))
        os.makedirs(os.path.join(self.folder, "real/sub"))
        os.symlink("real/sub", os.path.join(self.folder, "link"))
        self.assertIn("given twice",
                      self.refused("render", "builtin:box", "-o", "link/../a.csv", "-o", "real/a.csv"))
        self.write("box.obj", BOX)
        os.rename(os.path.join(self.folder, "box.obj"), os.path.join(self.folder, "in.ply"))
        self.assertIn("is an input", self.refused("render", "in.ply", "-o", "in.ply"))
        self.assertIn("did you mean 'intensity'?",
                      self.refused("render", "builtin:box", "-o", "x.pcd", "--columns", "xyz,intensty"))

    def test_files_of_the_scene_are_never_overwritten(self):
        self.write("paint.npy", "P6 1 1 255\nabc")
        self.write("paint.mtl", "newmtl paint\nmap_Kd paint.npy\n")
        self.write("box.obj", "mtllib paint.mtl\nusemtl paint\n" + BOX)
        self.write("sensor.bin", "optics: {width: 9, height: 9, fov_deg: 30}\n")
        self.write("scene.yaml", "models: [{model: box.obj}]\nsensor: sensor.bin\n")
        os.symlink("paint.mtl", os.path.join(self.folder, "link.csv"))
        os.link(os.path.join(self.folder, "box.obj"), os.path.join(self.folder, "box.ply"))
        for name in ("paint.npy", "link.csv", "sensor.bin", "box.ply"):
            for command in (("box.obj", "--sensor", "sensor.bin"), ("scene.yaml",)):
                with self.subTest(name, command=command):
                    error = self.refused("render", *command, "-o", name)
                    self.assertIn(name, error)
                    self.assertIn("is an input file", error)
                    self.assertIn("choose another name", error)

    def test_numbers(self):
        render = ("render", "builtin:box", "-o", "x.pcd")
        for arguments, text in (
                (("--width", "0"), "1 to 65536"),
                (("--height", "-3"), "1 to 65536"),
                (("--width", "1000000"), "65536"),
                (("--width", "65000", "--height", "65000"), "this machine's memory"),
                (("--width", "abc"), "--width"),
                (("--width", "2.5"), "--width"),
                (("--fov", "nan"), "above 0 and below 180"),
                (("--fov", "180"), "above 0 and below 180"),
                (("--fov", "20", "--fx", "100"), "give one of them"),
                (("--fx", "-1"), "--fx: -1; allowed: pixels above 0"),
                (("--cx", "nan"), "--cx: nan"),
                (("--near", "3", "--far", "2"), "near below far"),
                (("--near", "-1"), "0 or above"),
                (("--far", "nan"), "--far"),
                (("--ambient", "inf"), "--ambient"),
                (("--attenuation", "1,2"), "3 finite numbers"),
                (("--attenuation", "0,0,0"), "attenuation"),
                (("--eye", "1,2,nan"), "finite"),
                (("--scale", "0"), "--scale: 0; allowed: a number from 1e-15 to 1e15 or its negative, which mirrors, or three"),
                (("--scale", "1,0,1"), "--scale: 0; allowed"),
                (("--scale", "1,2"), "--scale: '1,2'"),
                (("--model-q", "0,0,0,0"), "length 0"),
                (("--camera-z", "inf"), "--camera-z"),
                (("--eye", "1,1,1", "--camera-z", "4"), "both are given; give one of them"),
                (("--depth-scale", "0"), "above 0"),
                (("--threads", "-1"), "--threads"),
                (("--unit", "km"), "--unit"),
                (("--up", "w"), "--up"),
                (("--frame", "body"), "--frame"),
                (("--width", "1.5"), "--width: '1.5'; allowed: a whole number"),
                (("--width", ""), "--width"),
                (("--legacy-output", ""), "--legacy-output"),
                (("--fov", "abc"), "--fov: 'abc'; allowed: a number"),
                (("--fov", "1e-300"), "--fov: 1e-300"),
                (("--fov", "20", "--fov", "30"), "--fov: given more than once"),
                (("--fov",), "--fov: there is no value"),
                (("--fx", "1e300"), "--fx: 1e+300"),
                (("--scale", "1e300"), "--scale: 1e+300"),
                (("--ambient", "1e300"), "--ambient: 1e+300"),
                (("--attenuation", "-1,0,1"), "--attenuation: '-1,0,1'"),
                (("--rain", "5"), "weather: the sensor 'depth camera' has no lidar_equation"),
                (("--rain", "-5"), "--rain: -5; allowed: a number from 0 to 1000"),
                (("--snow", "nan"), "--snow: nan; allowed: a number from 0 to 1000"),
                (("--target", "1,1,1"), "--target: there is no --eye; give --eye too"),
                (("--visibility", "0.5"), "weather, visibility_m: 0.5; allowed: metres from 1"),
                (("--columns", "xyz,foo"), "--columns"),
                (("--sensor-pose", "0,0,0,0,0,0,0"), "--sensor-pose"),
                (("--sensor-pose", "nan,0,0,1,0,0,0"), "--sensor-pose"),
                (("--eye", "0,0,5", "--up-vector", "0,0,1"), "--up-vector 1,0,0"),
                (("--frame", "rso"), "did you mean ros?"),
                (("--renderer", "magic"), "rays")):
            with self.subTest(arguments):
                self.assertIn(text, self.refused(*render, *arguments))

    def test_layouts(self):
        render = ("render", "nofile.ply", "-o", "x.pcd")
        error = self.refused(*render, "--layout", "velodine")
        self.assertIn("--layout: 'velodine'; allowed: minimal, velodyne, ouster, ouster-2022, livox, livox-custom, robosense, hesai, autoware", error)
        self.assertIn("did you mean velodyne?", error)
        for columns in ("xyz", "default"):
            error = self.refused(*render, "--layout", "velodyne", "--columns", columns)
            self.assertIn("both are given; give one of them", error)
        for outputs in (["-o", "x.png", "-o", "x.bin"], ["-o", "x.kitti"], ["-o", "x.osi"], ["-o", "x.las"], ["-o", "x.pcap"]):
            error = self.refused("render", "builtin:box", *outputs, "--sensor", "VLP-16", "--layout", "ouster")
            self.assertIn("no output takes a layout", error)
        self.assertIn("a bag, or an output with the suffix .pcd .ply .npz .csv;", error)

    def test_options_of_packets_and_messages_without_such_an_output(self):
        scan = ("render", "builtin:box", "--eye", "0,0,0", "--sensor")
        for option in (["--ouster-profile", "LEGACY"], ["--packet-topics"]):
            error = self.refused(*scan, "OS1-32", *option, "-o", "x.pcd")
            self.assertIn(f"{option[0]}: no output has ", error)
            self.assertIn(f"or leave {option[0]} out", error)
        self.assertIn("--livox-data-type: no output has packets",
                      self.refused(*scan, "Livox-Avia", "--livox-data-type", "1", "-o", "x.mcap"))
        self.assertIn("--image-transport: no output has ROS messages",
                      self.refused("render", "builtin:box", "--image-transport", "both", "-o", "x.pcd"))

    def test_options_of_packets_and_messages_with_other_sensors(self):
        scan = ("render", "builtin:box", "--eye", "0,0,0", "--sensor", "VLP-16")
        self.assertIn("--ouster-profile: it has no effect with Velodyne VLP-16; allowed: a preset of an Ouster sensor; leave",
                      self.refused(*scan, "--ouster-profile", "LEGACY", "-o", "x.pcap"))
        self.assertIn("--livox-data-type: it has no effect with",
                      self.refused(*scan, "--livox-data-type", "2", "-o", "x.pcap"))
        self.assertIn("--image-transport: it has no effect with",
                      self.refused(*scan, "--image-transport", "both", "-o", "x.mcap"))
        self.succeed(*scan, "-o", "scan.pcap")
        self.assertIn("--ouster-profile: the packets of Velodyne VLP-16; allowed: an Ouster sensor",
                      self.refused("decode", "scan.pcap", "--sensor", "VLP-16", "--ouster-profile", "LEGACY", "-o", "y.pcd"))

    def test_options_of_ros2_without_a_connection_to_it(self):
        self.succeed("stream", "builtin:box", "--width", "8", "--height", "6", "--frames", "1", "--record", "r.jsonl")
        for option in (["--ros2-interface", "auto"], ["--namespace", "robot"]):
            for command in (["stream", "builtin:box", "-o", "x.pcd"], ["replay", "r.jsonl"]):
                error = self.refused(*command, *option)
                self.assertIn(f"{option[0]}: given without a connection to ROS 2; add --ros2", error)

    def test_options_are_checked_before_anything_is_loaded(self):
        for arguments, text in ((("--renderer", "magic"), "--renderer: 'magic'; allowed: auto, rays"),
                                (("--eye", "1,2"), "--eye"),
                                (("--fov", "200"), "--fov")):
            error = self.refused("render", "nofile.ply", "-o", "x.pcd", *arguments)
            self.assertIn(text, error)
            self.assertNotIn("nofile.ply", error)

    def test_errors_of_outputs_name_the_option(self):
        self.assertIn("--output, x.pdc", self.refused("render", "builtin:box", "-o", "x.pdc"))
        self.assertIn("--legacy-output, no/x.pcd", self.refused("render", "builtin:box", "--legacy-output", "no/x"))
        os.mkfifo(os.path.join(self.folder, "pipe.pcd"))
        self.assertIn("--output, pipe.pcd: is a pipe",
                      self.refused("render", "builtin:box", "-o", "pipe.pcd"))

    def test_a_limit_on_file_size_is_an_error_and_leaves_nothing(self):
        done = subprocess.run(["glidar", "render", "builtin:box", "-o", "x.csv"], cwd=self.folder,
                              env=self.environment, capture_output=True, text=True, check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE,
                                                                    (65536, 65536)))
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("x.csv: cannot write: File too large", done.stderr)
        self.assertEqual(self.files(), [])

    def test_a_stream_with_few_file_descriptors_is_refused(self):
        found = {}
        for limit in range(4, 65):  # with 3, the dynamic loader cannot open its libraries
            done = subprocess.run(
                ["glidar", "stream", "builtin:box", "--width", "4", "--height", "4", "--frames", "1", "--port",
                 str(free_ports()), "--foxglove", "127.0.0.1:0", "--subscribers", "0", "--quiet"],
                cwd=self.folder, env=self.environment, capture_output=True, text=True, check=False,
                preexec_fn=lambda limit=limit: resource.setrlimit(resource.RLIMIT_NOFILE, (limit, limit)))  # fmt: skip
            self.assertIn(done.returncode, (0, 2), f"{limit}: {done.stderr}")
            if done.returncode == 2:
                self.assertRegex(done.stderr, "^glidar: error: ")
            found[limit] = done.returncode
        self.assertEqual({found[limit] for limit in range(4, 20)}, {2})
        self.assertEqual(found[64], 0)

    def test_a_limit_on_file_size_does_not_blame_the_model(self):
        self.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + "f 1 2 3\n" * 20000)
        limited = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (65536, 65536))}
        done = subprocess.run(["glidar", "info", "a.obj"], cwd=self.folder, env=self.environment, capture_output=True,
                              text=True, check=False, **limited)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("a.obj: its triangles and textures exceed the limit of this process on the size of files, 65536 "
                      "bytes; raise the limit (ulimit -f)", done.stderr)
        self.assertNotIn("corrupt", done.stderr)

    def test_an_error_while_loading_leaves_old_files_alone(self):
        self.write("x.pcd", "old")
        self.write("broken.ply", "neither a header nor triangles\n")
        self.refused("render", "broken.ply", "-o", "x.pcd")
        with open(os.path.join(self.folder, "x.pcd"), encoding="utf-8") as file:
            self.assertEqual(file.read(), "old")


if __name__ == "__main__":
    unittest.main()
