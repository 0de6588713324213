#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar stream --record and glidar replay: the same bytes on any machine."""

import json
import os
import shutil
import signal
import tempfile
import time
import unittest

from stream_support import SMALL, StreamTest

from cli_support import free_ports
from lockstep_test import CLIENT, Server, body
from stream_client import pose_message
from waiting import wait_until

SCENE = """models:
  - model: box.obj
    motion: {tumbling: {moments_kg_m2: [1, 2, 2.5], rate_deg_s: [5, 40, 5]}}
sensor: {optics: {type: pinhole, width: 32, height: 24, fov_deg: 20}, rate_hz: 20, noise: [{type: range_gaussian, sigma_m: 0.01}]}
sensor_pose: {look_at: {eye: [8, 0, 0], target: [0, 0, 0]}}
"""


class ReplayTest(StreamTest):
    def lines(self, name="r.jsonl"):
        return [json.loads(line) for line in self.bytes_of(name).decode().splitlines()]

    def files_of(self, prefix):
        return {name[len(prefix):]: self.bytes_of(name) for name in self.files()
                if name.startswith(prefix) and name.endswith(".pcd")}

    def record_scene(self, *arguments):
        self.write("scene.yaml", SCENE)
        self.succeed("stream", "scene.yaml", "--frames", "6", "--rate", "max", "--record", "r.jsonl", "-o",
                     "first.pcd", *arguments)


class Replay(ReplayTest):
    def test_of_a_scene_in_motion_writes_the_same_files(self):
        self.record_scene()
        done = self.succeed("replay", "r.jsonl", "-o", "again.pcd")
        self.assertIn("6 frames", done.stdout)
        self.assertEqual(len(self.files_of("first")), 6)
        self.assertEqual(self.files_of("again"), self.files_of("first"))
        self.assertEqual(len(set(self.files_of("first").values())), 6)

    def test_recordings_do_not_name_the_cache_folder(self):
        self.record_scene("--cache-folder", "own_cache")
        head = self.lines()[0]
        arguments = head["command"]["arguments"]
        self.assertFalse([one for one in arguments if "cache" in one], arguments)
        self.assertTrue(os.listdir(os.path.join(self.folder, "own_cache")))
        for spelling in (["--cache-folder", "evil"], ["--cache-folder=evil"]):
            head["command"]["arguments"] = arguments + spelling
            self.write("evil.jsonl", "\n".join(map(json.dumps, [head, *self.lines()[1:]])) + "\n")
            self.succeed("replay", "evil.jsonl")
            self.assertNotIn("evil", self.files())

    def test_of_a_rig_keeps_its_sensors_apart(self):
        self.write("rig.yaml", "models: [{model: box.obj, pose: {position: [6, 0, 0]}}]\n"
                               "sensors: [{name: a, sensor: VLP-16}, {name: b, sensor: VLP-16}]\n"
                               "rig_pose: {position: [0, 0, 0]}\n")
        self.succeed("stream", "rig.yaml", "--frames", "2", "--rate", "max", "--record", "r.jsonl", "-o", "first.pcd")
        self.succeed("replay", "r.jsonl", "-o", "again.pcd")
        self.assertEqual(len(self.files_of("first")), 4)
        self.assertEqual(self.files_of("again"), self.files_of("first"))

    def test_in_another_folder_needs_the_same_relative_paths(self):
        self.record_scene()
        with tempfile.TemporaryDirectory() as elsewhere:
            for name in ("r.jsonl", "scene.yaml", "box.obj"):
                shutil.copy(os.path.join(self.folder, name), elsewhere)
            self.succeed("replay", os.path.join(elsewhere, "r.jsonl"), "-o", "again.pcd")
            self.assertEqual(self.files_of("again"), self.files_of("first"))
            os.remove(os.path.join(elsewhere, "box.obj"))
            self.assertIn("box.obj", self.refused("replay", os.path.join(elsewhere, "r.jsonl"), "--quiet").split("\n")[-2])

    def test_of_a_simulators_poses_gives_the_same_clouds(self):
        program, simulator, subscriber = self.in_the_loop("--pose-queue", "100", "--record", "r.jsonl")
        for k in range(5):
            attitude = (0.9, 0.1 * k, 0.2, -0.3)
            length = sum(x * x for x in attitude) ** 0.5
            simulator.send(pose_message(100 + k, [x / length for x in attitude], (0.1, 0.2, 9 + 0.1 * k)))
        simulator.shut_down()
        clouds = subscriber.clouds_until_shutdown()
        self.finished(program, 0)
        self.assertEqual([line["stamp_ns"] for line in self.lines()[1:-1]], [100, 101, 102, 103, 104])
        self.port = free_ports()  # the first subscriber would reconnect to the old one, without a handshake
        program = self.start("r.jsonl", "--port", str(self.port), command="replay")
        again = self.subscriber()
        again.shake()
        replayed = again.clouds_until_shutdown()
        self.finished(program, 0)
        self.assertEqual([(stamp, points.tobytes()) for stamp, points in replayed],
                         [(stamp, points.tobytes()) for stamp, points in clouds])

    def test_of_lock_step_repeats_every_request(self):
        sensor = body((6, 0, 0), (0.5, -0.5, -0.5, 0.5))
        spun = body((0.1, 0, 0), (0.8, 0, 0.6, 0), rate=(0.3, 2, 0.1), velocity=(0.5, 0, 0))
        with Server(self, "builtin:asteroid", *SMALL, "--record", "r.jsonl") as server:
            socket = server.connect()
            moments = [(k * 1000, k, k, [sensor, spun]) for k in range(3)] + [(5, 2**63, 0, [sensor, spun])]
            socket.send(CLIENT["request"](["xyz"], moments))
            socket.recv_multipart()
            socket.send(CLIENT["request"](["xyz"], [(7, 1, 9, [sensor])]))  # objects where the scene has them
            socket.recv_multipart()
            self.assertEqual(server.end()[0], 143)
        self.assertEqual([line["seed"] for line in self.lines()[1:-1]], [0, 1, 2, 2**63, 1])
        self.assertIn("5 frames", self.succeed("replay", "r.jsonl").stdout)

    def test_of_a_scanner_is_the_same_for_requests_in_any_order(self):
        """The beams of a repeated frame are those of its number, not of the previous frame."""
        sensor = body((3, 0, 0), (0, 0, 0, 1))
        with Server(self, "builtin:asteroid", "--sensor", "Livox-Avia", "--record", "r.jsonl") as server:
            socket = server.connect()
            for number in (0, 2, 0, 1):
                socket.send(CLIENT["request"](["xyz"], [(0, 1, number, [sensor])]))
                socket.recv_multipart()
            self.assertEqual(server.end()[0], 143)
        self.succeed("replay", "r.jsonl")

    def test_of_lock_step_writes_and_publishes_every_frame(self):
        """Clients may give all frames one number and time."""
        sensor = body((6, 0, 0), (0.5, -0.5, -0.5, 0.5))
        with Server(self, "builtin:asteroid", *SMALL, "--record", "r.jsonl") as server:
            socket = server.connect()
            for k in range(3):
                socket.send(CLIENT["request"](["xyz"], [(0, 1, 0, [sensor, body((0, 0.1 * k, 0))])]))
                socket.recv_multipart()
            server.end()
        self.succeed("replay", "r.jsonl", "-o", "again.pcd")
        self.assertEqual(len(set(self.files_of("again").values())), 3)
        program = self.start("r.jsonl", "--port", str(self.port), command="replay")
        subscriber = self.subscriber()
        subscriber.shake()
        self.assertEqual([stamp for stamp, _ in subscriber.clouds_until_shutdown()], [1, 2, 3])
        self.finished(program, 0)

    def test_of_lock_step_follows_a_scene_that_moves_its_objects(self):
        self.write("scene.yaml", SCENE)
        sensor = body((8, 0, 0), (0.5, -0.5, -0.5, 0.5))
        with Server(self, "scene.yaml", "--record", "r.jsonl") as server:
            socket = server.connect()
            socket.send(CLIENT["request"](["xyz"], [(0, 1, 0, [sensor]), (10**9, 1, 0, [sensor])]))
            (_, first), (_, later) = CLIENT["clouds"](socket.recv_multipart())
            self.assertNotEqual(first["xyz"].tobytes(), later["xyz"].tobytes())
            server.end()
        self.succeed("replay", "r.jsonl")

    def test_with_one_thread_is_the_same(self):
        self.record_scene("--threads", "2")
        self.assertNotIn("--threads", self.lines()[0]["command"]["arguments"])
        self.succeed("replay", "r.jsonl", "--threads", "1")

    def test_ends_after_the_given_frames_and_keeps_its_rate(self):
        self.record_scene()
        begin = time.monotonic()
        done = self.succeed("replay", "r.jsonl", "--rate", "10", "--frames", "4")
        self.assertGreater(time.monotonic() - begin, 0.29)
        self.assertIn("4 frames", done.stdout)


class Recording(ReplayTest):
    def test_is_complete_after_a_signal(self):
        program = self.start(self.box, *SMALL, "--camera-z", "10", "--object-rate", "0,1,0", "--rate", "50", "--record",
                             "r.jsonl", "-o", "s.pcd")
        wait_until(lambda: "s_000004.pcd" in self.files(), "five frames", program)
        program.send_signal(signal.SIGINT)
        self.finished(program, 130)
        self.assertGreaterEqual(len(self.lines()), 7)
        self.succeed("replay", "r.jsonl")

    def test_does_not_replace_files_of_the_scene(self):
        self.write("scene.yaml", SCENE)
        self.assertIn("is an input file", self.refused("stream", "scene.yaml", "--record", "box.obj", "-o", "s.pcd"))

    def test_is_a_sufficient_output(self):
        self.succeed("stream", self.box, *SMALL, "--camera-z", "10", "--rate", "max", "--frames", "2", "--record", "r.jsonl")
        self.assertEqual(len(self.lines()), 4)

    def test_and_statistics_do_not_replace_each_other_or_inputs(self):
        self.write("scene.yaml", SCENE)
        out = ("--frames", "1", "--rate", "max")
        for arguments in (("--stats", "scene.yaml", "-o", "s.pcd"), ("--stats", "x", "--record", "x"),
                          ("--stats", "s_000000.pcd", "-o", "s.pcd"), ("--record", "s_000000.pcd", "-o", "s.pcd")):
            with self.subTest(arguments):
                done = self.run_program("stream", "scene.yaml", *out, *arguments)
                self.assertEqual(done.returncode, 2, done.stdout)
                self.assertIn("is an input file, or another output writes it", done.stderr)
        self.assertEqual(self.bytes_of("scene.yaml").decode(), SCENE)
        self.record_scene()
        before = self.bytes_of("r.jsonl")
        self.assertEqual(self.run_program("replay", "r.jsonl", "--stats", "r.jsonl").returncode, 2)
        self.assertEqual(self.bytes_of("r.jsonl"), before)

    def test_in_a_missing_folder_is_refused(self):
        self.assertIn("--record", self.refused("stream", self.box, "--record", "no/r.jsonl", "-o", "s.pcd"))


class Refusals(ReplayTest):
    def test_a_frame_that_differs_is_an_error(self):
        self.record_scene()
        changed = self.bytes_of("box.obj").decode().replace("v 1.0 1.0 1.0", "v 1.1 1.0 1.0")
        self.write("box.obj", changed)
        done = self.run_program("replay", "r.jsonl")
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn("box.obj has changed since it was recorded", done.stderr)
        self.assertRegex(done.stderr, "frame [0-5]: the repeated frame differs from the recorded one")

    def test_a_replay_that_is_refused_leaves_no_output(self):
        self.record_scene()
        self.write("box.obj", self.bytes_of("box.obj").decode().replace("v 1.0 1.0 1.0", "v 1.1 1.0 1.0"))
        before = self.files()
        for name in ("x.mcap", "x.rosbag2", "x.osi", "x.kitti", "x.pcd"):
            done = self.run_program("replay", "r.jsonl", "-o", name)
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertIn("differs from the recorded one", done.stderr)
            self.assertNotIn("wrote", done.stdout)
            self.assertEqual(self.files(), before, name)

    def test_other_files_are_refused(self):
        self.record_scene()
        good = self.bytes_of("r.jsonl").decode().splitlines()
        cases = {"": "it is empty", "{}": ":1: ", "no json": ":1: ", '{"recording": 2}': "format 2",
                 good[0].replace('"stream"', '"render"'): "it has another command"}
        for text, words in cases.items():
            with self.subTest(text):
                self.write("bad.jsonl", text)
                self.assertIn(words, self.refused("replay", "bad.jsonl"))
        self.assertIn("no such file", self.refused("replay", "none.jsonl"))
        os.mkfifo(os.path.join(self.folder, "pipe"))
        self.assertIn("not a regular file", self.refused("replay", "pipe"))

    def test_a_truncated_or_invalid_line_is_named(self):
        self.record_scene()
        head, first, *rest = self.bytes_of("r.jsonl").decode().splitlines()
        wrong = json.loads(first)
        wrong["sensor"] = 7
        scaled = dict(json.loads(first), rig=[2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0], objects=[])
        short = dict(scaled, rig=[1, 0, 0])
        large = dict(json.loads(first), sensor=2**32)
        below = dict(json.loads(first), number=-1)
        unproven = dict(json.loads(first), frame_hash="")
        for line, words in ((first[:40], "bad.jsonl:3: "), (json.dumps(wrong), "sensor 7 and 0 objects"),
                            (json.dumps(scaled), "not a rigid transform"), (json.dumps(short), "3 numbers, instead of 12 or 18"),
                            (json.dumps(large), "sensor: 4294967296 is not a count"),
                            (json.dumps(below), "number: -1 is not a count"),
                            (json.dumps(unproven), "frame_hash: not 32 digits"),
                            ('{"frames": 7}', "1 frames, but its last line states 7")):
            with self.subTest(words):
                self.write("bad.jsonl", "\n".join([head, first, line, *rest]) + "\n")
                done = self.run_program("replay", "bad.jsonl")
                self.assertEqual(done.returncode, 2, done.stdout)
                self.assertIn(words, done.stderr)

    def test_a_damaged_line_is_explained_in_plain_words(self):
        self.record_scene()
        head, first, *rest = self.bytes_of("r.jsonl").decode().splitlines()
        for line, words in ((first[:40], "bad.jsonl:3: its text ends too early, at column 41"),
                            ("x" + first, "bad.jsonl:3: its text is not valid JSON from column 1 on"),
                            (first.replace('"seed"', '"sead"'), "bad.jsonl:3: the key 'seed' is missing")):
            with self.subTest(words):
                self.write("bad.jsonl", "\n".join([head, first, line, *rest]) + "\n")
                done = self.run_program("replay", "bad.jsonl")
                self.assertEqual(done.returncode, 2, done.stdout)
                self.assertIn(words, done.stderr)
                self.assertIn("copy the file again, or record again", done.stderr)
                self.assertNotIn("exception", done.stderr)

    def test_blank_lines_are_skipped(self):
        self.record_scene()
        self.write("r.jsonl", self.bytes_of("r.jsonl").decode().replace("\n", "\n\n"))
        self.assertIn("6 frames", self.succeed("replay", "r.jsonl").stdout)

    def test_names_that_are_not_utf8_cannot_be_recorded(self):
        name = b"b\xff.yaml"
        with open(os.path.join(os.fsencode(self.folder), name), "w", encoding="utf-8") as scene:
            scene.write("models: [{model: 'builtin:box'}]")
        error = self.refused("stream", os.fsdecode(name), "--frames", "1", "--record", "r.jsonl")
        self.assertIn("not UTF-8", error)
        self.assertNotIn("r.jsonl", self.files())

    def test_a_truncated_recording_is_an_error(self):
        self.record_scene()
        for kept in (1, 3):
            self.write("bad.jsonl", "\n".join(self.bytes_of("r.jsonl").decode().splitlines()[:kept]) + "\n")
            done = self.run_program("replay", "bad.jsonl")
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertIn("it ends before its last line", done.stderr)

    def test_an_invalid_rate_is_refused(self):
        self.record_scene()
        for rate in ("-5", "nan", "inf", "fast"):
            self.assertIn("--rate", self.refused("replay", "r.jsonl", "--rate", rate))


if __name__ == "__main__":
    unittest.main()
