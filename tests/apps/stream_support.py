# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs glidar stream between a client and a simulator of the original protocol."""

import json
import subprocess

from cli_support import MAX_WAIT_S, CliTest, box_of, free_ports, tcp
from skipping import importing

with importing():
    import zmq

from stream_client import Simulator, Subscriber
from waiting import wait_until

SMALL = ("--width", "32", "--height", "24", "--fov", "20")


class StreamTest(CliTest):
    def setUp(self):
        super().setUp()
        self.context = zmq.Context()
        self.addCleanup(self.context.term)
        self.box = self.write("box.obj", box_of(2.0))
        self.port = free_ports()
        self.physics = free_ports()

    def start(self, *arguments, command="stream"):
        """The running program, which ends with the test."""
        return self.start_by("glidar", command, *arguments)

    def start_by(self, *command):
        program = subprocess.Popen(command, cwd=self.folder, env=self.environment,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.end, program)
        return program

    @staticmethod
    def end(program):
        if program.poll() is None:
            program.kill()
            print(program.args, *program.communicate())
        for pipe in (program.stdout, program.stderr):
            pipe.close()
        program.wait()

    def publish(self, *arguments):
        return self.publish_box(*SMALL, *arguments)

    def publish_box(self, *arguments):
        return self.start(self.box, "--port", str(self.port), "--stats", "stats.json", *arguments)

    def in_the_loop(self, *arguments):
        """The program between a simulator and a subscriber, after their handshakes."""
        simulator = self.simulator()
        program = self.publish("--pose-source", tcp(self.physics), *arguments)
        subscriber = self.subscriber()
        subscriber.shake()
        simulator.shake()
        return program, simulator, subscriber

    def simulator(self):
        def bound():
            try:
                return Simulator(self.context, self.physics)
            except zmq.ZMQError:  # the previous port is not free yet
                return None
        simulator = wait_until(bound, "the simulator's ports")
        self.addCleanup(simulator.close)
        return simulator

    def subscriber(self, **options):
        subscriber = Subscriber(self.context, self.port, **options)
        self.addCleanup(subscriber.close)
        return subscriber

    def finished(self, program, code):
        out, err = program.communicate(timeout=MAX_WAIT_S)
        self.assertEqual(program.returncode, code, out + err)
        return err

    def stats(self):
        return json.loads(self.bytes_of("stats.json"))
