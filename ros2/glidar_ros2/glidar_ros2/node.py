# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A node that measures in steps: services reset, step, set_pose and spawn of simulation_interfaces, clouds and the clock out.

It runs `glidar stream SCENE --lockstep`, so that every frame is at the requested poses and time."""

import tempfile
from pathlib import Path

import numpy as np
import rclpy
import yaml
from glidar_ros2.lockstep import LockstepError, Server, world_of
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2, PointField
from simulation_interfaces.msg import Result
from simulation_interfaces.srv import ResetSimulation, SetEntityState, SpawnEntity, StepSimulation

COLUMNS = ("xyz", "intensity", "ring", "time")
POINT = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4"), ("ring", "<u2"), ("time", "<f4")])
TYPES = {"<f4": PointField.FLOAT32, "<u2": PointField.UINT16}


def points_of(cloud):
    """The columns of a reply as the points of ros-drivers/velodyne; times are seconds since the start of the frame."""
    points = np.zeros(len(cloud["xyz"]), POINT)
    for axis, name in enumerate("xyz"):
        points[name] = cloud["xyz"][:, axis]
    points["intensity"] = cloud["intensity"][:, 0]
    points["ring"] = cloud["ring"][:, 0]
    points["time"] = cloud["time"][:, 0] * 1e-9
    return points


def with_model(scene, name, uri, pose):
    """The text of a scene file with one more object."""
    content = yaml.safe_load(Path(scene).read_text(encoding="utf-8"))
    position, (w, x, y, z) = pose[:3], pose[3:]
    content.setdefault("models", []).append(
        {"name": name, "model": uri, "pose": {"position": position, "orientation": {"w": w, "x": x, "y": y, "z": z}}})
    return yaml.safe_dump(content)


def numbers_of(pose):
    p, q = pose.position, pose.orientation
    return [p.x, p.y, p.z, q.w, q.x, q.y, q.z]


class Lockstep(Node):
    def __init__(self):
        super().__init__("glidar")
        scene = self.declare_parameter("scene", "").value
        rate_hz = self.declare_parameter("rate_hz", 10.0).value
        self.prefix = self.declare_parameter("frame_prefix", "").value
        self.period_ns = round(1e9 / rate_hz)
        self.scene = Path(scene)
        self.server = None
        self.spawned = []
        self.start(self.scene)
        self.clock = self.create_publisher(Clock, "/clock", 1)
        self.create_service(ResetSimulation, "~/reset", self.answer(self.reset))
        self.create_service(StepSimulation, "~/step", self.answer(self.step))
        self.create_service(SetEntityState, "~/set_pose", self.answer(self.set_pose))
        self.create_service(SpawnEntity, "~/spawn", self.answer(self.spawn))

    def start(self, scene):
        """Runs GLIDAR on a scene, and forgets the time."""
        server = Server(scene)
        self.stop()
        self.server = server
        description = server.client.describe()
        self.world = world_of(description, self.period_ns)
        self.sensors = description["sensors"]
        self.clouds = [self.create_publisher(PointCloud2, f"{sensor['name'].replace(' ', '_')}/points", 5)
                       for sensor in self.sensors]

    def stop(self):
        if self.server is not None:
            self.server.stop()

    def answer(self, work):
        """A service whose result states whether it succeeded."""
        def serve(request, response):
            try:
                work(request)
                response.result.result = Result.RESULT_OK
            except (LockstepError, OSError, ValueError, yaml.YAMLError) as error:
                response.result.result = Result.RESULT_OPERATION_FAILED
                response.result.error_message = str(error)
            return response
        return serve

    def reset(self, _request):
        self.world.reset()

    def step(self, request):
        for _ in range(request.steps):
            self.publish_frame()
            self.world.frame += 1

    def set_pose(self, request):
        twist = request.state.twist
        pose = numbers_of(request.state.pose)
        self.world.set_pose(request.entity, pose[:3], pose[3:], (twist.linear.x, twist.linear.y, twist.linear.z),
                            (twist.angular.x, twist.angular.y, twist.angular.z))

    def spawn(self, request):
        text = with_model(self.scene, request.name, request.uri, numbers_of(request.initial_pose.pose))
        # beside the scene, because it names models from its own folder
        with tempfile.NamedTemporaryFile("w", suffix=".yaml", dir=self.scene.parent, delete=False, encoding="utf-8") as file:
            file.write(text)
        self.spawned.append(Path(file.name))
        before = self.world
        self.start(file.name)
        self.scene = Path(file.name)
        self.world.frame = before.frame
        for name, body in zip(before.names, before.bodies, strict=True):
            self.world.bodies[self.world.names.index(name)] = body

    def publish_frame(self):
        stamp = {"sec": self.world.t_ns // 10**9, "nanosec": self.world.t_ns % 10**9}
        for index, sensor in enumerate(self.sensors):
            cloud = self.server.client.measure(index, COLUMNS, self.world.t_ns, self.world.frame, self.world.bodies)
            points = points_of(cloud)
            message = PointCloud2(height=1, width=len(points), point_step=POINT.itemsize, is_dense=True,
                                  row_step=POINT.itemsize * len(points), data=points.tobytes())
            message.header.frame_id = self.prefix + sensor["name"]
            message.header.stamp.sec, message.header.stamp.nanosec = stamp["sec"], stamp["nanosec"]
            message.fields = [PointField(name=name, offset=offset, datatype=TYPES[kind.str], count=1)
                              for name, (kind, offset) in POINT.fields.items()]
            self.clouds[index].publish(message)
        clock = Clock()
        clock.clock.sec, clock.clock.nanosec = stamp["sec"], stamp["nanosec"]
        self.clock.publish(clock)

    def close(self):
        self.stop()
        for path in self.spawned:
            path.unlink(missing_ok=True)


def main():
    rclpy.init()
    node = Lockstep()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.close()
        node.destroy_node()


if __name__ == "__main__":
    main()
