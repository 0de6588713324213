#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The output files of a command, including standard output. The built program is found in
PATH."""

import fcntl
import itertools
import json
import os
import pty
import resource
import signal
import subprocess
import unittest

from cli_support import MAX_WAIT_S, CliTest

RIG = """models:
  - {model: builtin:box, pose: {position: [6, 0, 0]}}
  - {model: builtin:box, name: behind, pose: {position: [-6, 0, 0]}}
sensors:
  - {name: lidar, sensor: VLP-16}
  - name: camera
    sensor: {optics: {type: pinhole, width: 40, height: 30, fov_deg: 40}}
    pose: {euler_deg: {roll: -90, yaw: -90}}
"""
PLACED = "rig_pose: {position: [0, 0, 0]}\n"


class Rigs(CliTest):
    def setUp(self):
        super().setUp()
        self.write("rig.yaml", RIG + PLACED)

    def test_an_output_that_does_not_fit_a_sensor_is_left_out_with_a_note(self):
        done = self.succeed("render", "rig.yaml", "-o", "r.depth.png", "-o", "r.pcd", "--no-sidecar")
        self.assertEqual(self.files(), ["r_camera.depth.png", "r_camera.pcd", "r_lidar.pcd", "rig.yaml"])
        self.assertIn("r.depth.png is not written for lidar: it has beams that point back", done.stderr)

    def test_an_output_that_fits_none_of_the_sensors_is_an_error_before_any_work(self):
        self.write("rig.yaml", RIG[: RIG.index("  - name: camera")] + "  - {name: second, sensor: VLP-16}\n" + PLACED)
        reported = self.refused("render", "rig.yaml", "-o", "r.pcd", "-o", "r.depth.png")
        self.assertIn("fits none of the sensors on the rig: lidar: it has beams", reported)
        self.assertIn("write .range.png", reported)

    def test_a_stream_leaves_the_same_output_out(self):
        self.succeed("stream", "rig.yaml", "--frames", "2", "-o", "r.depth.png", "--no-sidecar")
        self.assertTrue([name for name in self.files() if name.startswith("r_camera_")], self.files())
        self.assertFalse([name for name in self.files() if name.startswith("r_lidar_")], self.files())

    def test_a_rig_cannot_write_to_standard_output(self):
        reported = self.refused("render", "rig.yaml", "-o", "-", "--format", "csv")
        self.assertIn("--sensor-name", reported)
        done = self.succeed("render", "rig.yaml", "--sensor-name", "camera", "-o", "-", "--format", "csv")
        self.assertEqual(done.stdout.count("\n"), 40 * 30 + 1)


class LasFiles(CliTest):
    def test_they_have_the_columns_that_the_format_needs_beside_the_requested_ones(self):
        self.succeed("render", "builtin:box", "--sensor", "VLP-16", "--eye", "3,0,0", "-o", "a.las", "-o", "a.csv",
                     "--columns", "xyz,ring")  # fmt: skip
        columns = {column["name"] for column in json.loads(self.bytes_of("a.glidar.json"))["files"][0]["columns"]}
        self.assertEqual(columns, {"xyz", "ring", "range", "row", "col", "class"})
        self.assertEqual(self.bytes_of("a.csv").splitlines()[0], b"x,y,z,ring")


class Folders(CliTest):
    def test_every_frame_of_a_folder_has_its_own_information(self):
        self.succeed("render", "builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0", "--duration", "0.2",
                     "--fisher", "-o", "out.kitti/")  # fmt: skip
        found = sorted(name for name in os.listdir(self.folder) if name.endswith(".fisher.json"))
        self.assertEqual(found, ["out_000000.fisher.json", "out_000001.fisher.json"])
        self.assertEqual(len(os.listdir(os.path.join(self.folder, "out.kitti", "velodyne"))), 2)


class KittiFolders(CliTest):
    def test_a_second_run_into_the_same_folder_is_refused_while_the_first_one_writes(self):
        run = ("render", "builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0", "--duration", "0.1", "-o", "out.kitti")
        os.mkdir(os.path.join(self.folder, "out.kitti"))
        first = os.open(os.path.join(self.folder, "out.kitti"), os.O_RDONLY)
        fcntl.flock(first, fcntl.LOCK_EX)  # as a run that writes to it
        self.assertIn("out.kitti: another run writes to this folder now; wait until it has ended", self.refused(*run))
        self.assertEqual(os.listdir(os.path.join(self.folder, "out.kitti")), [])
        os.close(first)
        self.succeed(*run)
        self.assertIn("poses.txt", os.listdir(os.path.join(self.folder, "out.kitti")))


class Failures(CliTest):
    def test_when_one_output_fails_no_file_of_the_frame_exists(self):
        # the box is 7 m and more away: 20000 units per metre do not fit 16 bits
        reported = self.refused("render", "builtin:box", "-o", "a.pcd", "-o", "a.depth.png", "-o", "a.csv",
                            "--depth-scale", "20000")
        self.assertIn("--depth-scale", reported)

    def test_an_error_lists_what_was_written_before_it(self):
        # from the second frame on, the box is farther than 65535 / 6200 m
        self.write("scene.yaml", "models: [{model: builtin:box, pose: {position: [0, 0, 10]},"
                                 " motion: {twist: {velocity_m_s: [0, 0, 2]}}}]\n"
                                 "sensor: {optics: {type: pinhole, width: 8, height: 6, fov_deg: 20}, rate_hz: 1}\n"
                                 "sensor_pose: {position: [0, 0, 0]}\n")
        done = self.run_program("render", "scene.yaml", "--duration", "3", "--no-sidecar", "-o", "a.depth.png",
                                "--depth-scale", "6200", "--quiet")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(self.files(), ["a_000000.depth.png", "scene.yaml"])
        self.assertIn("1 output was written before that, from a_000000.depth.png", done.stderr)

    def test_a_full_disk_leaves_no_file_of_the_frame(self):
        limit = 3_000_000  # bytes of one file: a.csv is larger, a.depth.png smaller
        done = subprocess.run(
            ["glidar", "render", "builtin:box", "-o", "a.depth.png", "-o", "a.csv", "--columns", "all"],
            cwd=self.folder, env=self.environment, capture_output=True, text=True, timeout=MAX_WAIT_S, check=False,
            preexec_fn=lambda: (signal.signal(signal.SIGXFSZ, signal.SIG_IGN),
                                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))))  # fmt: skip
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("no part of this file remains", done.stderr)
        self.assertEqual(self.files(), [])


    def test_a_full_disk_names_the_bag_and_not_its_hidden_folder(self):
        limit = 400_000  # bytes of one file
        for command, name in itertools.product((("render", "--duration", "1"), ("stream", "--frames", "10")),
                                               ("a.rosbag2", "a.mcap")):
            done = subprocess.run(
                ["glidar", *command, "builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0", "-o", name],
                cwd=self.folder, env=self.environment, capture_output=True, text=True, timeout=MAX_WAIT_S, check=False,
                preexec_fn=lambda: (signal.signal(signal.SIGXFSZ, signal.SIG_IGN),
                                    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))))  # fmt: skip
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertIn(f"{name}: cannot ", done.stderr)
            self.assertIn("raise the limit on the size of files", done.stderr)
            self.assertNotIn("misuse", done.stderr)
            self.assertNotIn(".glidar-", done.stderr)
            self.assertEqual(self.files(), [])


class Images(CliTest):
    def test_a_model_given_directly_has_an_id_that_fits_an_image_of_instances(self):
        self.succeed("render", "builtin:box", "-o", "x.instance.png", "-o", "x.pcd")
        with open(os.path.join(self.folder, "x.glidar.json"), encoding="utf-8") as file:
            self.assertEqual([one["id"] for one in json.load(file)["instances"]], [1])


class StandardOutput(CliTest):
    def test_it_has_the_bytes_of_the_file_and_nothing_else(self):
        for name in ("pcd", "ply", "csv", "bin", "npz", "depth.png", "depth.tiff"):
            self.succeed("render", "builtin:box", "-o", "a." + name, "--no-sidecar", "--quiet")
            done = subprocess.run(["glidar", "render", "builtin:box", "-o", "-", "--format", name], cwd=self.folder,
                                  env=self.environment, capture_output=True, timeout=MAX_WAIT_S, check=True)  # fmt: skip
            self.assertEqual(done.stdout, self.bytes_of("a." + name), name)
            self.assertIn(b"wrote -", done.stderr)
            os.remove(os.path.join(self.folder, "a." + name))
        self.assertEqual(self.files(), [])

    def test_a_full_disk_is_reported_without_claims_about_sent_data(self):
        with open("/dev/full", "wb") as full:
            done = subprocess.run(["glidar", "render", "builtin:box", "-o", "-", "--format", "csv"], cwd=self.folder,
                                  env=self.environment, stdout=full, stderr=subprocess.PIPE, text=True, timeout=MAX_WAIT_S,
                                  check=False)  # fmt: skip
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("the data sent so far is incomplete", done.stderr)
        self.assertNotIn("left behind", done.stderr)
        self.assertEqual(self.files(), [])

    def test_commands_that_write_sequences_do_not_offer_it(self):
        for command in ("stream", "replay"):
            reported = self.succeed(command, "--help").stdout
            self.assertIn("--output", reported)
            self.assertNotIn("stdout", reported)
            self.assertNotIn("--format", reported)
        self.assertIn("-: standard output", self.succeed("render", "--help").stdout)

    def test_files_are_written_together_with_it(self):
        done = self.succeed("render", "builtin:box", "-o", "-", "--format", "csv", "-o", "a.pcd", "--quiet")
        self.assertEqual(self.files(), ["a.glidar.json", "a.pcd"])
        self.assertEqual(done.stderr, "")

    def test_it_is_given_once_and_with_its_format(self):
        self.assertIn("add --format csv", self.refused("render", "builtin:box", "-o", "-"))
        self.assertIn("given twice", self.refused("render", "builtin:box", "-o", "-", "-o", "-", "--format", "csv"))
        self.assertIn("no -o -", self.refused("render", "builtin:box", "-o", "a.pcd", "--format", "csv"))
        self.assertIn("--format", self.refused("render", "builtin:box", "-o", "-", "--format", "kitti"))
        for more in (["render", "builtin:box", "--duration", "1"], ["stream", "builtin:box", "--frames", "2"]):
            self.assertIn("one frame of one sensor", self.refused(*more, "-o", "-", "--format", "csv"))

    def test_a_closed_pipe_ends_the_program_quietly(self):
        for ignored in (False, True):  # SIGPIPE, as some parents leave it
            program = subprocess.Popen(
                ["glidar", "render", "builtin:box", "-o", "-", "--format", "csv", "-o", "a.csv", "--quiet"],
                cwd=self.folder, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                restore_signals=not ignored)  # fmt: skip
            program.stdout.readline()
            program.stdout.close()
            self.assertEqual(program.stderr.read(), b"")
            program.stderr.close()
            self.assertEqual(program.wait(300), 141 if ignored else -signal.SIGPIPE)
            self.assertEqual(self.files(), ["a.csv", "a.glidar.json"])

    def test_a_terminal_gets_text_only(self):
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        done = subprocess.run(["glidar", "render", "builtin:box", "-o", "-", "--format", "pcd"], cwd=self.folder,
                              env=self.environment, stdout=theirs, stderr=subprocess.PIPE, text=True, timeout=MAX_WAIT_S,
                              check=False)  # fmt: skip
        os.close(theirs)
        self.assertEqual(done.returncode, 2)
        self.assertIn("standard output is a terminal, and this format is binary", done.stderr)


if __name__ == "__main__":
    unittest.main()
