#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The ROS 2 package in ros2/, without ROS: its manifest, its Python files, and its node with simple replacements of rclpy and messages."""

import ast
import math
import os
import sys
import tempfile
import types
import unittest
import xml.etree.ElementTree as ET
from pathlib import Path

try:
    import numpy as np
    import yaml  # noqa: F401
    import zmq  # noqa: F401
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

PACKAGE = Path(__file__).resolve().parents[2] / "ros2" / "glidar_ros2"
sys.path.insert(0, str(PACKAGE))
sys.dont_write_bytecode = True
FILES = sorted(PACKAGE.rglob("*.py"))
# Modules of the Python standard library and of the package; others must be dependencies.
KEYS = {"numpy": "python3-numpy", "yaml": "python3-yaml", "zmq": "python3-zmq"}
RIG = """models: [{name: room, model: "builtin:box:size=20,16,6"}]
sensors: [{name: top, sensor: VLP-16, pose: {position: [0.5, 0, 0]}}]
rig_pose: {position: [1, 0, 0]}
"""


class Anything:
    """A message: members appear when they are named."""

    def __init__(self, **members):
        self.__dict__.update(members)

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        self.__dict__[name] = Anything()
        return self.__dict__[name]


class FakeNode:
    parameters = {}

    def __init__(self, name):
        self.name, self.published, self.services = name, {}, {}

    def declare_parameter(self, name, default):
        return Anything(value=self.parameters.get(name, default))

    def create_publisher(self, _kind, topic, _depth):
        sent = self.published.setdefault(topic, [])
        return Anything(publish=sent.append)

    def create_service(self, _kind, name, serve):
        self.services[name] = serve


def install_stand_ins():
    names = {"rclpy": ("init", "spin"), "rclpy.node": (), "rosgraph_msgs.msg": ("Clock",), "sensor_msgs.msg": ("PointCloud2",),
             "simulation_interfaces.msg": (),
             "simulation_interfaces.srv": ("ResetSimulation", "SetEntityState", "SpawnEntity", "StepSimulation")}
    for name, members in names.items():
        module = types.ModuleType(name)
        for member in members:
            setattr(module, member, Anything if member[0].isupper() else lambda *_: None)
        sys.modules[name] = module
        sys.modules.setdefault(name.split(".")[0], types.ModuleType(name.split(".")[0]))
    sys.modules["rclpy.node"].Node = FakeNode
    sys.modules["sensor_msgs.msg"].PointField = type("PointField", (Anything,), {"FLOAT32": 7, "UINT16": 4})
    sys.modules["simulation_interfaces.msg"].Result = type("Result", (), {"RESULT_OK": 1, "RESULT_OPERATION_FAILED": 4})


class Package(unittest.TestCase):
    def test_the_manifest_names_the_package_and_all_that_it_imports(self):
        root = ET.parse(PACKAGE / "package.xml").getroot()
        self.assertEqual((root.tag, root.get("format")), ("package", "3"))
        order = [child.tag for child in root]
        self.assertEqual(order[:5], ["name", "version", "description", "maintainer", "license"])
        self.assertEqual(root.findtext("export/build_type"), "ament_python")
        self.assertIn("@", root.find("maintainer").get("email"))
        setup = (PACKAGE / "setup.py").read_text(encoding="utf-8")
        self.assertIn(f'NAME = "{root.findtext("name")}"', setup)
        self.assertIn(f'version="{root.findtext("version")}"', setup)
        depends = {child.text for child in root if child.tag == "exec_depend"}
        imported = {name.split(".")[0] for path in FILES if path.name != "setup.py" for name in imports(path)}
        ours = set(sys.stdlib_module_names) | {"glidar_ros2"}
        self.assertEqual({KEYS.get(name, name) for name in imported - ours} | {"robot_state_publisher"}, depends)
        for path in ("resource/glidar_ros2", "launch/stream.launch.py", "launch/lockstep.launch.py"):
            self.assertTrue((PACKAGE / path).is_file())
            self.assertIn(path.split("/")[0], setup)

    def test_python_files_have_no_unused_names_and_short_lines(self):
        self.assertGreater(len(FILES), 5)
        for path in FILES:
            text = path.read_text(encoding="utf-8")
            self.assertTrue(text.startswith("# SPDX-FileCopyrightText"), path)
            self.assertLessEqual(max(map(len, text.split("\n"))), 130, path)
            used = {node.id for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Name)}
            for name in imports(path, local=True):
                self.assertIn(name, used, path)

    def test_a_robot_description_has_the_rig(self):
        from glidar_ros2.rig import robot_description, rpy

        turn = [math.cos(0.3), 0, 0, math.sin(0.3)]
        root = ET.fromstring(robot_description([("top", [1, 2, 3, *turn]), ('a"b', [0, 0, 0, 1, 0, 0, 0])]))
        self.assertEqual([link.get("name") for link in root.findall("link")], ["base_link", "top", 'a"b'])
        origin = root.find("joint/origin")
        self.assertEqual(origin.get("xyz"), "1 2 3")
        self.assertAlmostEqual(float(origin.get("rpy").split()[2]), 0.6, 8)
        dice = np.random.default_rng(1)
        quaternions = [q / np.linalg.norm(q) for q in dice.normal(size=(200, 4))]
        quaternions += [np.array([0.5, 0.5, 0.5, 0.5]), np.array([0.5, -0.5, 0.5, -0.5]), np.sqrt([0.5, 0, 0.5, 0])]
        for q in quaternions:
            self.assertLess(np.abs(matrix_of(rpy(q)) - matrix_from(q)).max(), 1e-6)

    def test_stream_commands_have_the_parameters(self):
        from glidar_ros2.rig import stream_command

        self.assertEqual(stream_command("rig.yaml", "velodyne camera=realsense", "map", "r1/", "--rate '10'"),
                         ["glidar", "stream", "rig.yaml", "--ros2", "--tf", "map", "--as", "velodyne", "--as", "camera=realsense",
                          "--frame-prefix", "r1/", "--rate", "10"])

    def test_the_node_steps_moves_spawns_and_resets(self):
        install_stand_ins()
        from glidar_ros2 import node as module

        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder, "rig.yaml")
            scene.write_text(RIG, encoding="utf-8")
            FakeNode.parameters = {"scene": str(scene), "rate_hz": 10.0, "frame_prefix": "r1/"}
            node = module.Lockstep()
            self.addCleanup(node.close)
            self.exercise(node)
            node.close()
            self.assertEqual(os.listdir(folder), ["rig.yaml"])

    def exercise(self, node):
        def call(service, /, **request):
            result = node.services[f"~/{service}"](Anything(**request), Anything()).result
            return result.result, result.__dict__.get("error_message", "")

        clouds, clock = node.published["top/points"], node.published["/clock"]
        self.assertEqual(call("step", steps=2), (1, ""))
        self.assertEqual((len(clouds), [c.clock.nanosec for c in clock]), (2, [0, 100_000_000]))
        self.assertEqual(clouds[0].header.frame_id, "r1/top")
        self.assertGreater(clouds[0].width, 20_000)
        self.assertAlmostEqual(ahead(clouds[0]), 10 - 1.5, 1)  # the wall at x = 10
        pose = Anything(position=Anything(x=3.0, y=0.0, z=0.0), orientation=Anything(w=1.0, x=0.0, y=0.0, z=0.0))
        zero = Anything(x=0.0, y=0.0, z=0.0)
        state = Anything(pose=pose, twist=Anything(linear=zero, angular=zero))
        self.assertEqual(call("set_pose", entity="base_link", state=state)[0], 1)
        self.assertIn("known: base_link room", call("set_pose", entity="nobody", state=state)[1])
        call("step", steps=1)
        self.assertAlmostEqual(ahead(clouds[2]), 10 - 3.5, 1)
        box = Anything(position=Anything(x=6.5, y=0.0, z=0.0), orientation=pose.orientation)
        self.assertEqual(call("spawn", name="crate", uri="builtin:box:size=1,1,1", initial_pose=Anything(pose=box)), (1, ""))
        call("step", steps=1)
        self.assertAlmostEqual(ahead(clouds[3]), 6 - 3.5, 1)
        self.assertEqual(clock[-1].clock.nanosec, 300_000_000)
        self.assertEqual(call("reset")[0], 1)
        call("step", steps=1)
        self.assertEqual(clock[-1].clock.nanosec, 0)


def imports(path, local=False):
    """The modules that a file imports, or the names that it gives them."""
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found += [(alias.asname or alias.name) if local else alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            found += [alias.asname or alias.name for alias in node.names] if local else [node.module]
    return found


def ahead(cloud):
    """The distance straight ahead."""
    kind = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("i", "<f4"), ("ring", "<u2"), ("time", "<f4")])
    points = np.frombuffer(cloud.data, kind)
    return float(points["x"][np.argmin(np.hypot(points["y"], points["z"]) - 1e-3 * (points["x"] > 0))])


def matrix_of(angles):
    (a, b, c), (d, e, f) = np.cos(angles), np.sin(angles)
    about_x = np.array([[1, 0, 0], [0, a, -d], [0, d, a]])
    about_y = np.array([[b, 0, e], [0, 1, 0], [-e, 0, b]])
    about_z = np.array([[c, -f, 0], [f, c, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def matrix_from(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


if __name__ == "__main__":
    unittest.main()
