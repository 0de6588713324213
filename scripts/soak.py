#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Tests glidar stream under load for a long time, in lock-step and with the original protocol at once: steady and
reconnecting clients, some that vanish or send nonsense, and a subscriber that never reads. Reports latencies, missed
clouds and memory over time. With --hostile also peers that send garbage, endless messages and floods, ask for too much,
and hold connections.

Exit code 1 unless memory is flat, or returns to its level after the attackers, every request was answered, and every
reply was the first one's bytes again.
"""

import argparse
import json
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
from array import array
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import zmq

from hostile_clients import HostileClients

# Resident memory of the last quarter of the time may exceed that of the second by so much: arenas of malloc come and go
# with threads and clients, some 0.1 MB. A leak of one reply (100 kB) in a hundred exceeds it in ten seconds, one of 100
# bytes a request in two minutes.
MEMORY_TOLERANCE_MB = 2.0
# Among attackers, memory depends on how fast a loaded machine disconnects them. After they have left, while all other
# clients continue, it must return to at most this above its earlier level; a leak of one endless message in a hundred
# soon exceeds it.
HOSTILE_TOLERANCE_MB = 20.0
HELD_TOLERANCE_BYTES = 1 << 20  # of queues and unread replies, which the program counts, once all clients have left
MEMORY_LOOK_S = 0.5
MAX_WAIT_S = 600  # for a reply, a beginning and an end; machines may be very busy
PROGRAMS = ("lock-step", "streaming")
SIZE = ("builtin:asteroid", "--width", "64", "--height", "64", "--fov", "30")
EXAMPLE = """examples:
  ./dev soak             # an hour; picture in out/soak.png
  ./dev soak 180
  scripts/soak.py --hostile --seconds 600 --picture hostile.png
  scripts/soak.py --seconds 180 --picture soak.png    # with glidar in PATH"""


@dataclass
class Findings:
    """What all clients found; each list is appended to by many threads."""

    latencies: list = field(default_factory=list)  # (seconds since start, seconds) pairs, an array a client
    requests: int = 0
    vanished: int = 0
    nonsense: int = 0
    connections: int = 0
    clouds: int = 0
    lost_clouds: int = 0
    attacks: int = 0
    errors: list = field(default_factory=list)
    lock: threading.Lock = field(default_factory=threading.Lock)

    def has_all(self):
        """Whether every client has done something."""
        return min(self.requests, self.vanished, self.nonsense, self.clouds) > 0

    def add(self, **counts):
        with self.lock:
            for name, count in counts.items():
                setattr(self, name, getattr(self, name) + count)


class Soak(HostileClients):
    """Both programs, and the clients around them, each in a thread."""

    def __init__(self, folder, seconds, is_hostile=False):
        self.folder, self.seconds, self.findings, self.is_hostile = Path(folder), seconds, Findings(), is_hostile
        self.context, self.over, self.first_replies = zmq.Context(), threading.Event(), {}
        self.attack_end = threading.Event()
        self.log = open(self.folder / "log.txt", "w", encoding="utf-8")
        self.lockstep = self.start("--lockstep", "tcp://127.0.0.1:*", "--stats", "lockstep.json")
        self.endpoint = self.lockstep.stdout.readline().split()[-1]
        while True:  # two free ports side by side
            self.port = 20000 + 2 * int(np.random.default_rng().integers(6000))
            self.stream = self.start("--port", str(self.port), "--subscription-timeout", "0", "--publish-queue", "4",
                                     "--rate", "60", "--object-rate", "0,0.5,0", "--stats", "stream.json")
            if self.listens():
                break
        self.begin_stream()
        self.started = time.monotonic()

    def start(self, *arguments):
        return subprocess.Popen(["glidar", "stream", *SIZE, *arguments], cwd=self.folder, text=True,
                                stdout=subprocess.PIPE, stderr=self.log)

    def listens(self):
        """Whether the stream waits for its first subscriber; else its ports were in use, and it has ended."""
        line = f"handshakes at port {self.port + 1}"
        while self.stream.poll() is None:
            if line in (self.folder / "log.txt").read_text(encoding="utf-8"):
                return True
            self.over.wait(0.05)
        self.stream.stdout.close()
        return False

    def begin_stream(self):
        """Shakes hands, which the stream waits for."""
        with self.context.socket(zmq.REQ) as hand:
            hand.linger, hand.rcvtimeo = 0, 1000 * MAX_WAIT_S
            hand.connect(f"tcp://127.0.0.1:{self.port + 1}")
            hand.send(b"")
            hand.recv()

    def run(self):
        """Resident memory of both programs over time, once every client has begun: rows of seconds, MB, MB."""
        clients = [self.ask, self.ask, self.ask_and_reconnect, self.vanish, self.send_nonsense, self.read,
                   self.read_and_reconnect, self.never_read]
        threads = self.begin(clients, 0)
        memory = []
        self.watch(memory, lambda now: self.findings.has_all() or now > MAX_WAIT_S)
        if self.is_hostile:
            self.attackers_come_and_go(memory, len(clients))
        else:
            memory.clear()
            end = time.monotonic() - self.started + self.seconds
            self.watch(memory, lambda now: now > end)
        self.over.set()
        for thread in threads:
            thread.join()
        return np.array(memory)

    def begin(self, clients, first_seed):
        threads = [threading.Thread(target=self.guarded, args=(client, seed))
                   for seed, client in enumerate(clients, first_seed)]
        for thread in threads:
            thread.start()
        return threads

    def watch(self, memory, is_enough):
        """Appends the memory of both programs until is_enough(seconds since the start), or until the run is over."""
        while not self.over.is_set():
            now = time.monotonic() - self.started
            if self.lockstep.poll() is not None or self.stream.poll() is not None:
                self.findings.errors.append("glidar ended before its time")
                return self.over.set()
            memory.append((now, resident_mb(self.lockstep), resident_mb(self.stream)))
            if is_enough(now):
                return None
            self.over.wait(MEMORY_LOOK_S)
        return None

    def attackers_come_and_go(self, memory, first_seed):
        """Memory must return to its level before them."""
        level = np.array(memory[-1][1:])
        end = time.monotonic() - self.started + self.seconds
        attackers = self.begin(self.hostile_clients(), first_seed)
        self.watch(memory, lambda now: now > end)
        self.attack_end.set()
        for thread in attackers:
            thread.join()
        deadline = time.monotonic() - self.started + MAX_WAIT_S
        self.watch(memory, lambda now: (memory[-1][1:] <= level + HOSTILE_TOLERANCE_MB).all() or now > deadline)
        for name, before, after in zip(PROGRAMS, level, memory[-1][1:]):
            if after > before + HOSTILE_TOLERANCE_MB:
                self.findings.errors.append(f"{name}: memory stays at {after:.1f} MB after the attacks; it was "
                                            f"{before:.1f} MB before them, allowed are {HOSTILE_TOLERANCE_MB} MB more")

    def guarded(self, client, seed):
        try:
            client(np.random.default_rng(seed))
        except Exception as error:  # whatever it is: the run is over and has failed
            self.findings.errors.append(f"{client.__name__}: {error!r}")
            self.over.set()

    def end(self):
        """Statistics of both programs as they wrote them at their end."""
        for program in (self.lockstep, self.stream):
            if program.poll() is None:
                program.send_signal(signal.SIGTERM)
            try:
                code = program.wait(timeout=MAX_WAIT_S)
            except subprocess.TimeoutExpired:
                program.kill()
                code = program.wait()
            program.stdout.close()
            if not self.findings.errors and code != 128 + signal.SIGTERM:
                self.findings.errors.append(f"{program.args[-1]}: exit code {code}")
        self.context.destroy(linger=0)
        self.log.close()
        return [json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
                for path in (self.folder / "lockstep.json", self.folder / "stream.json")]

    # clients in lock-step

    def connect(self):
        client = self.context.socket(zmq.REQ)
        client.linger = 0
        client.rcvtimeo = 1000 * MAX_WAIT_S
        client.connect(self.endpoint)
        self.findings.add(connections=1)
        return client

    def ask_once(self, client, number, latencies):
        """Sends the request of this number; its reply must be the one that it had at first."""
        sent = time.monotonic()
        client.send(request(number))
        reply = b"".join(client.recv_multipart())
        done = time.monotonic()
        latencies.extend((sent - self.started, done - sent))
        if self.first_replies.setdefault(number, reply) != reply:
            raise ValueError(f"request {number} has another reply than before")
        if struct.unpack_from("<H", reply, 6)[0] != 2:
            raise ValueError(f"request {number}: {reply[16:].decode(errors='replace')}")
        self.findings.add(requests=1)

    def ask(self, random, per_connection=None):
        latencies = array("d")
        self.findings.latencies.append(latencies)
        while not self.over.is_set():
            with self.connect() as client:
                asked = 0
                while not self.over.is_set() and asked != per_connection:
                    self.ask_once(client, int(random.integers(40)), latencies)
                    asked += 1

    def ask_and_reconnect(self, random):
        self.ask(random, per_connection=5)

    def vanish(self, random):
        while not self.over.wait(0.1):
            with self.connect() as client:
                client.linger = 50
                client.send(request(int(random.integers(40))))
                self.over.wait(0.01 * random.random())
            self.findings.add(vanished=1)

    def send_nonsense(self, random):
        with self.connect() as client:
            while not self.over.wait(0.1):
                whole = request(int(random.integers(40)))
                client.send(whole[:int(random.integers(len(whole)))])
                if struct.unpack_from("<H", client.recv_multipart()[0], 6)[0] != 3:
                    raise ValueError("nonsense was answered with a cloud")
                self.findings.add(nonsense=1)

    # subscribers of the original protocol

    def subscriber(self, **options):
        clouds = self.context.socket(zmq.SUB)
        clouds.linger = 0
        for name, value in options.items():
            setattr(clouds, name, value)
        clouds.subscribe(b"c")
        clouds.connect(f"tcp://127.0.0.1:{self.port}")
        self.findings.add(connections=1)
        return clouds

    def read(self, _random, per_connection=None):
        while not self.over.is_set():
            with self.subscriber() as clouds:
                last, taken = None, 0
                while not self.over.is_set() and taken != per_connection:
                    if not clouds.poll(200):
                        continue
                    (stamp,) = struct.unpack_from("<Q", clouds.recv(), 1)
                    self.findings.add(clouds=1, lost_clouds=0 if last is None else stamp - last - 1)
                    last, taken = stamp, taken + 1

    def read_and_reconnect(self, random):
        self.read(random, per_connection=10)

    def never_read(self, _random):
        with self.subscriber(rcvhwm=1, rcvbuf=65536):
            self.over.wait()


def request(number):
    """One of 40 that are unlike in pose, motion, seed, columns, and number of moments."""
    random = np.random.default_rng(number)
    names = (["xyz"], ["xyz", "intensity"], ["range", "status", "normal"], ["xyz", "instance"])[number % 4]
    moments = 1 + 7 * (number % 5 == 0)
    head = struct.pack("<4s2HQ6I", b"GLDR", 1, 1, number, 0, int("xyz" in names and number % 3 == 0), len(names), moments,
                       1, 0)
    message = head + b"".join(name.encode().ljust(24, b"\0") for name in names)
    for k in range(moments):
        away = random.uniform(4, 12)
        sensor = [away, 0, 0, 0.5, -0.5, -0.5, 0.5, 0, 0, 0, 0, 0, 0]
        attitude = random.normal(size=4)
        rock = [0, 0, 0, *attitude / np.linalg.norm(attitude), *random.normal(size=6) * 0.1]
        message += struct.pack("<qQII26d", k * 10**8, number, k, 0, *sensor, *rock)
    return message


def resident_mb(program):
    for line in Path(f"/proc/{program.pid}/status").read_text(encoding="utf-8").splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) / 1024
    return 0.0  # it is ending


def growth_mb(times, memory):
    """From the second quarter of the time to the last, of medians."""
    quarter = np.minimum((4 * (times - times[0]) / (times[-1] - times[0])).astype(int), 3)
    return np.median(memory[quarter == 3]) - np.median(memory[quarter == 1])


def find_errors(findings, memory, stats, is_hostile=False):
    """Everything that must not be."""
    if findings.errors:
        return findings.errors
    errors = []
    for column, name in enumerate(PROGRAMS, 1):
        growth = growth_mb(memory[:, 0], memory[:, column])
        if growth > MEMORY_TOLERANCE_MB and not is_hostile:
            errors.append(f"{name}: memory grew by {growth:.1f} MB, allowed are {MEMORY_TOLERANCE_MB}")
    held = stats[0].get("held_bytes")
    if held is None:
        errors.append("lock-step: its statistics have no held_bytes")
    elif held > HELD_TOLERANCE_BYTES:
        errors.append(f"lock-step: it holds {held} bytes for clients that have left")
    if not findings.has_all():
        errors.append("a client did nothing")
    return errors


def report(findings, memory, stats, latencies):
    milli = 1e3 * np.percentile(latencies[:, 1], [50, 99, 100])
    served, streamed = stats
    print(f"lock-step: {findings.requests} requests, each with the reply it had at first; {findings.vanished} clients "
          f"vanished, {findings.nonsense} sent nonsense\n"
          f"  latency {milli[0]:.1f} ms, 99 %: {milli[1]:.1f} ms, longest {milli[2]:.1f} ms")
    clouds, latency = streamed.get("clouds", {}), streamed.get("latency_ms", {})
    print(f"streaming: {clouds.get('sent')} clouds sent, {clouds.get('missed')} missed while a queue was full; readers took "
          f"{findings.clouds} and lost {findings.lost_clouds}\n"
          f"  latency {latency.get('p50', 0):.1f} ms, 99 %: {latency.get('p99', 0):.1f} ms, longest "
          f"{latency.get('max', 0):.1f} ms")
    for column, name in enumerate(PROGRAMS, 1):
        print(f"memory, {name}: {memory[0, column]:.1f} MB at first, {memory[:, column].max():.1f} MB at most, "
              f"{memory[-1, column]:.1f} MB at last, {growth_mb(memory[:, 0], memory[:, column]):+.2f} MB from the second "
              "quarter to the last")
    if findings.attacks:
        print(f"{findings.attacks} attacks; cut off or refused: {served.get('errors')} {streamed.get('errors')}")
    print(f"{findings.connections} connections; {served.get('requests')} messages served")


def draw(memory, latencies, path):
    """Memory and latency over time."""
    from matplotlib.figure import Figure
    figure = Figure(figsize=(9.6, 3.2), dpi=100, layout="constrained")
    left, right = figure.subplots(1, 2)
    left.plot(memory[:, 0], memory[:, 1], label="lock-step")
    left.plot(memory[:, 0], memory[:, 2], label="streaming")
    left.set(xlabel="time, s", ylim=(0, 1.3 * memory[:, 1:].max()))
    left.set_title("resident memory, MB", fontsize=9)
    edges = np.linspace(0, latencies[:, 0].max(), 101)
    parts = np.digitize(latencies[:, 0], edges[1:-1])
    for quantile, name in ((50, "50 %"), (99, "99 %"), (100, "longest")):
        values = [1e3 * np.percentile(latencies[parts == k, 1], quantile) if (parts == k).any() else np.nan
                  for k in range(100)]
        right.semilogy(edges[:-1], values, label=name)
    right.set(xlabel="time, s")
    right.set_title("latency of requests in lock-step, ms", fontsize=9)
    for panel in (left, right):
        panel.legend(fontsize=8, loc="lower right")
        panel.grid(alpha=0.3)
    figure.savefig(path)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, epilog=EXAMPLE,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=3600, help="how long [3600]")
    parser.add_argument("--picture", metavar="FILE", help="draws memory and latency over time, as PNG")
    parser.add_argument("--hostile", action="store_true", help="with peers that keep to no rules")
    flags = parser.parse_args(arguments)
    if flags.seconds < 10:
        parser.error("--seconds: at least 10, otherwise memory is not meaningful")
    with tempfile.TemporaryDirectory() as folder:
        soak = Soak(folder, flags.seconds, flags.hostile)
        try:
            memory = soak.run()
        finally:
            stats = soak.end()
        log = Path(folder, "log.txt").read_text(encoding="utf-8")
    errors = find_errors(soak.findings, memory, stats, flags.hostile)
    if not soak.findings.errors:
        latencies = np.concatenate([np.array(one).reshape(-1, 2) for one in soak.findings.latencies])
        report(soak.findings, memory, stats, latencies)
        if flags.picture:
            draw(memory, latencies, flags.picture)
    for error in errors:
        print(f"soak: {error}", file=sys.stderr)
    if errors:
        print(log[-4000:], file=sys.stderr)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
