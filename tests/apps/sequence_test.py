# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Sequences of frames from the command line. The built program is found in PATH."""

import csv
import json
import os
import struct
import unittest

from cli_support import CliTest


MOVING = """models: [{model: builtin:box, scale: 8}]
sensor: VLP-16
sensor_pose: {position: [0, 0, 0]}
sensor_motion: {twist: {velocity_m_s: [2, 0, 0]}}
"""


class Sequences(CliTest):
    def test_a_duration_gives_numbered_frames_that_join(self):
        self.write("scene.yaml", "models: [{model: builtin:box, scale: 8}]\nsensor: VLP-16\n"
                                 "sensor_pose: {position: [0, 0, 0]}\n"
                                 "sensor_motion: {twist: {velocity_m_s: [2, 0, 0]}}\n")
        columns = ("--columns", "xyz,time,ring", "--frame", "world", "--drop-invalid")
        self.succeed("render", "scene.yaml", "--duration", "0.3", "--deskew", "--ground-truth", *columns, "--per-frame", "-o", "a.csv")
        self.assertEqual([name for name in self.files() if name.endswith(".csv")],
                         ["a_000000.csv", "a_000001.csv", "a_000002.csv"])
        times = []
        for k in range(3):
            with open(os.path.join(self.folder, f"a_00000{k}.csv"), encoding="utf-8") as file:
                next(file)
                rows = [[float(number) for number in line.split(",")] for line in file]
            # Deskewed, every point is on a wall of the room; CSV keeps all digits.
            self.assertLess(max(abs(max(map(abs, row[:3])) - 8.0) for row in rows), 1e-9)
            times += [round(k * 1e8) + row[3] for row in rows if row[4] == rows[0][4]]
        steps = [later - earlier for earlier, later in zip(sorted(times), sorted(times)[1:])]
        self.assertLessEqual(max(abs(step - 55296.0) for step in steps), 1.0)  # VLP-16, in ns

    def test_a_sequence_names_its_frames_in_the_sidecar(self):
        self.succeed("render", "builtin:box", "--duration", "0.05", "--rate", "40", "--per-frame", "-o", "b.pcd")
        self.assertEqual(self.files(), ["b.glidar.json", "b_000000.glidar.json", "b_000000.pcd", "b_000001.glidar.json",
                                        "b_000001.pcd"])
        self.assertIn("--duration", self.refused("render", "builtin:box", "--duration", "-1", "-o", "b.pcd"))
        self.assertIn("a million frames",
                      self.refused("render", "builtin:box", "--duration", "1e9", "-o", "b.pcd"))

    def test_sidecars_are_few_and_store_once_what_repeats(self):
        models = ", ".join(f"{{model: builtin:box, pose: {{position: [{4 * k}, 9, 0]}}}}" for k in range(50))
        self.write("many.yaml", f"models: [{models}]\nsensor: VLP-16\n")
        outputs = ("a.pcd", "a.ply", "a.npz", "a.range.npy", "a.csv")
        words = [word for name in outputs for word in ("-o", name)]
        self.succeed("render", "many.yaml", *words)
        self.assertEqual([name for name in self.files() if name.endswith(".json")], ["a.glidar.json"])
        listed = json.loads(self.bytes_of("a.glidar.json"))["files"]
        self.assertEqual({one["file"] for one in listed}, set(outputs))
        whole = len(self.bytes_of("a.glidar.json"))
        self.succeed("render", "many.yaml", "--per-frame", "--duration", "0.3", *words)
        frames = [self.bytes_of(f"a_00000{k}.glidar.json") for k in range(3)]
        run = json.loads(self.bytes_of("a.glidar.json"))
        self.assertEqual((len(run["instances"]), run["sensor"]["name"]), (50, "Velodyne VLP-16"))
        for k, text in enumerate(frames):
            self.assertLess(len(text), 0.5 * whole)
            frame = json.loads(text)
            self.assertEqual((frame["run"], frame["frame"], frame["run_hash"]), ("a.glidar.json", k, run["run_hash"]))
            self.assertEqual({one["file"] for one in frame["files"]}, {name.replace("a.", f"a_00000{k}.") for name in outputs})

    def test_a_sidecar_of_another_run_is_refused(self):
        for sensor, name in (("VLP-16", "a"), ("Puck-Hi-Res", "b")):
            self.succeed("render", "builtin:box", "--sensor", sensor, "--eye", "0,0,0", "--duration", "0.1", "-o", f"{name}.npz")
        self.write("a.glidar.json", self.bytes_of("b.glidar.json").decode())
        self.assertIn("another run", self.refused("explain", "a_000000.npz", "--index", "0"))

    def run_rows(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_one_file_has_all_frames_in_the_order_of_time(self):
        self.write("scene.yaml", MOVING)
        common = ("render", "scene.yaml", "--duration", "0.3", "--ground-truth", "--columns", "xyz,range,ring", "--drop-invalid")
        done = self.succeed(*common, "-o", "a.csv", "-o", "a.pcd", "-o", "a.ply", "-o", "a.las", "-o", "a.npz")
        self.assertIn("wrote a.csv a.las a.pcd a.ply", done.stdout)
        self.assertEqual([name for name in self.files() if not name.endswith((".npz", ".json", ".yaml"))],
                         ["a.csv", "a.las", "a.pcd", "a.ply"])
        rows = self.run_rows("a.csv")
        stamps = [int(row["stamp"]) for row in rows]
        self.assertEqual(stamps, sorted(stamps))
        self.assertEqual(sorted({row["frame"] for row in rows}), ["0", "1", "2"])
        self.succeed(*common, "--per-frame", "--frame", "world", "--deskew", "-o", "b.csv")
        apart = [row for k in range(3) for row in self.run_rows(f"b_00000{k}.csv")]
        position = lambda row: (row["x"], row["y"], row["z"], row["ring"])
        self.assertEqual(sorted(map(position, rows)), sorted(map(position, apart)))
        header = self.bytes_of("a.pcd").split(b"DATA")[0].decode()
        self.assertIn(f"\nWIDTH {len(rows)}\nHEIGHT 1\n", header)
        self.assertIn(f"\nPOINTS {len(rows)}\n", header)
        self.assertIn(f"\nelement vertex {len(rows)}\n", self.bytes_of("a.ply").split(b"end_header")[0].decode())
        las = self.bytes_of("a.las")
        self.assertEqual(struct.unpack_from("<Q", las, 247)[0], len(rows))
        low = [struct.unpack_from("<d", las, 187 + 16 * axis)[0] for axis in range(3)]
        for axis, name in enumerate("xyz"):
            self.assertAlmostEqual(low[axis], min(float(row[name]) for row in rows), delta=1e-4)

    def test_points_of_a_file_of_all_frames_can_be_explained(self):
        self.write("scene.yaml", MOVING)
        self.succeed("render", "scene.yaml", "--duration", "0.3", "--columns", "xyz,range", "-o", "a.csv")
        rows = self.run_rows("a.csv")
        index = next(k for k, row in enumerate(rows) if row["frame"] == "2" and row["range"] != "nan")
        trace = self.succeed("explain", "a.csv", "--index", str(index)).stdout
        self.assertIn("frame 2", trace)
        self.assertIn(f"{float(rows[index]['range']):.4f}"[:6], trace)
        self.assertIn("--index", self.refused("explain", "a.csv", "--row", "0", "--col", "0"))

    def test_the_sidecar_of_a_run_lists_each_frame_once_with_boxes_that_have_points(self):
        self.write("scene.yaml", MOVING.replace("scale: 8}", "scale: 8, class: room}, {model: builtin:box, class: crate, "
                                                "pose: {position: [0, 0, 50]}}"))
        self.succeed("render", "scene.yaml", "--duration", "0.3", "--box-classes", "all", "-o", "a.csv", "-o", "a.las")
        sidecar = json.loads(self.bytes_of("a.glidar.json"))
        self.assertEqual([one["frame"] for one in sidecar["frames"]], [0, 1, 2])
        for frame in sidecar["frames"]:
            self.assertEqual(set(frame["points"]), {"a.csv", "a.las"})
            self.assertEqual([one["class"] for one in frame["boxes"]], ["room"])

    def test_a_file_in_axes_that_move_has_no_pose(self):
        self.write("scene.yaml", MOVING)
        for name, moves in (("sensor", True), ("world", False)):
            self.succeed("render", "scene.yaml", "--duration", "0.2", "--frame", name, "-o", "a.csv")
            pose = json.loads(self.bytes_of("a.glidar.json"))["files"][0]["world_from_cloud"]
            self.assertEqual(pose is None, moves)

    def test_a_las_file_of_a_run_that_starts_in_a_small_room_takes_far_points(self):
        self.write("scene.yaml", "models: [{model: builtin:box}, {model: builtin:box, name: hall, scale: 4000}]\n"
                                 "sensor: {optics: {type: pinhole, width: 8, height: 6, fov_deg: 60}, rate_hz: 10}\n"
                                 "sensor_pose: {position: [0, 0, 0]}\n"
                                 "sensor_motion: {twist: {velocity_m_s: [30000, 0, 0]}}\n")
        self.succeed("render", "scene.yaml", "--duration", "0.2", "-o", "a.las", "-o", "a.csv")
        las = self.bytes_of("a.las")
        self.assertEqual(struct.unpack_from("<Q", las, 247)[0], 2 * 8 * 6)
        self.assertEqual(struct.unpack_from("<d", las, 131)[0], 1e-4)
        self.assertGreater(max(abs(float(row["x"])) for row in self.run_rows("a.csv")), 2200.0)

    def test_an_empty_run_is_a_valid_file(self):
        self.succeed("render", "builtin:box", "--sensor", "VLP-16", "--eye", "900,0,0", "--duration", "0.2", "-o", "a.las",
                     "-o", "a.pcd", "--drop-invalid")
        self.assertIn(b"\nPOINTS 0\n", self.bytes_of("a.pcd"))
        self.assertEqual(struct.unpack_from("<Q", self.bytes_of("a.las"), 247)[0], 0)

    def test_a_run_that_fails_leaves_no_file_of_all_frames(self):
        self.write("scene.yaml", MOVING)
        self.refused("render", "scene.yaml", "--duration", "0.3", "-o", "a.csv", "-o", "no/b.npz")
        self.assertEqual(self.files(), ["scene.yaml"])

    def test_videos_are_joined_from_pictures(self):
        self.assertIn("ffmpeg -framerate 10 -i frame_%06d.png", self.refused("render", "builtin:box", "-o", "out.mp4"))


if __name__ == "__main__":
    unittest.main()
