#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Disks that fail and programs that are killed: nothing half written gets a name, every error is reported, and the same
command then gives the same bytes. The built program is found in PATH."""

import itertools
import json
import os
import shutil
import signal
import subprocess
import unittest
from pathlib import Path

from cli_support import BOX, CliTest

from faults import CALLS, ERRORS, NO_LIBRARY, Faults, library, random_below
from skipping import skip
from waiting import MAX_WAIT_S

SIZE = ("--width", "16", "--height", "12", "--fov", "40", "--threads", "1", "--quiet")
RENDER = ("render", "builtin:box", *SIZE, "-o", "out/a.pcd", "-o", "out/b.npz", "-o", "out/c.depth.tiff")
MOVING = ("stream", "builtin:box", *SIZE, "--object-rate", "0,0.5,0", "--rate", "max")
STREAM = (*MOVING, "--frames", "40")
RECORD = (*STREAM, "--record", "out/r.jsonl")
DURABLE = (*RECORD, "--durable")
SEED = 17
KILLS = 20


class FaultTest(CliTest):
    def setUp(self):
        super().setUp()
        self.out = Path(self.folder, "out")
        self.out.mkdir()
        self.faults = Faults(Path(self.folder, "fault_injection"), self.out)

    def empty(self):
        shutil.rmtree(self.out)
        self.out.mkdir(mode=0o700)

    def contents(self):
        return {path.name: path.read_bytes() for path in self.out.rglob("*") if path.is_file()}

    def with_fault(self, command, call, at=0, error="EIO"):
        self.faults.arm(call, at, error)
        return subprocess.run(["glidar", *command], cwd=self.folder, env=self.environment | self.faults.environment,
                              capture_output=True, text=True, timeout=MAX_WAIT_S, check=False, start_new_session=True)

    def count(self, command, call):
        """The number of such calls of the command without failures."""
        self.empty()
        done = self.with_fault(command, call)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.faults.calls

    def each_fault(self, command, check, calls=CALLS):
        """Runs the command with each injected error in turn, and check(call, error, the run) after each."""
        for call in calls:
            for error, at in itertools.product(ERRORS, range(1, self.count(command, call) + 1)):
                self.empty()
                with self.subTest(call=call, at=at, error=error):
                    done = self.with_fault(command, call, at, error)
                    self.assertGreater(self.faults.hits, 0)
                    check(call, error, done)

    def is_refused(self, done, error):
        """The errors name a file and the reason."""
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertRegex(done.stderr, f"glidar: error: .*out/[a-z_.0-9]*: cannot .*{ERRORS[error]}")

    def leaves_whole_files(self, whole):
        """All files are equal to those of an undisturbed run."""
        for name, content in self.contents().items():
            self.assertEqual(content, whole.get(name), name)

    def each_kill(self, command, prepare, check):
        """Kills the command at each of its calls, or at a random sample of them; each time after prepare(),
        and calls check()."""
        count = self.count(command, "any")
        drawn = sorted({1 + random_below(SEED, kill, count) for kill in range(KILLS)})
        for at in drawn if count > KILLS else range(1, count + 1):
            prepare()
            with self.subTest(seed=SEED, at=at):
                done = self.with_fault(command, "any", at, "kill")
                self.assertEqual(done.returncode, -signal.SIGKILL, done.stderr)
                check()


class Render(FaultTest):
    def test_every_failed_call_is_reported_and_leaves_no_partial_file(self):
        self.succeed(*RENDER)
        whole = self.contents()
        self.assertEqual(len(whole), 6)  # with sidecars

        def check(_, error, done):
            self.is_refused(done, error)
            self.leaves_whole_files(whole)

        self.each_fault(RENDER, check)
        self.succeed(*RENDER)
        self.assertEqual(self.contents(), whole)

    def test_nothing_is_synced(self):
        self.assertEqual(self.count(RENDER, "sync"), 0)

    def test_a_kill_at_any_call_leaves_no_partial_file_under_its_name(self):
        self.succeed(*RENDER)
        whole = self.contents()

        def check():
            hidden = {name: text for name, text in self.contents().items() if name.startswith(".glidar-")}
            self.leaves_whole_files(whole | hidden)
            self.succeed(*RENDER)
            self.assertEqual(self.contents(), whole | hidden)

        self.each_kill(RENDER, self.empty, check)

    def test_a_kill_while_files_are_written_leaves_none(self):
        if not self.has_unnamed_files():
            self.skipTest("no files without names; use another file system")
        for at in range(1, self.count(RENDER, "write") + 1):
            self.empty()
            with self.subTest(at=at):
                done = self.with_fault(RENDER, "write", at, "kill")
                self.assertEqual(done.returncode, -signal.SIGKILL, done.stderr)
                self.assertEqual(self.contents(), {})

    def has_unnamed_files(self):
        try:
            os.close(os.open(self.out, os.O_WRONLY | os.O_TMPFILE, 0o600))
        except OSError:
            return False
        return True


class Recording(FaultTest):
    def recorded(self):
        """The frames of a recording, whose last line has their number; None: no recording."""
        path = self.out / "r.jsonl"
        if not path.exists():
            return None
        lines = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
        self.assertEqual(lines[-1], {"frames": len(lines) - 2})
        return lines[1:-1]

    def test_every_failed_call_of_a_stream_is_reported(self):
        self.succeed(*DURABLE)
        whole = self.contents()

        def check(call, error, done):
            self.is_refused(done, error)
            self.leaves_whole_files(whole)
            if call == "sync" and self.faults.path == str(self.out.resolve()):
                self.assertEqual(self.contents(), whole)
                self.assertIn("write its folder to the disk", done.stderr)
                if error == "EIO":
                    self.assertIn("the file is in place and complete, but may not survive", done.stderr)
            else:
                self.assertEqual(self.contents(), {})

        self.each_fault(DURABLE, check)
        self.succeed(*DURABLE)
        self.assertEqual(self.contents(), whole)

    def test_a_recording_beside_a_cloud_that_cannot_be_written_is_complete(self):
        command = (*MOVING, "--frames", "8", "--record", "out/r.jsonl", "--durable", "-o", "out/scan.pcd")
        self.succeed(*command)
        whole = self.contents()
        frames = self.recorded()

        def check(_, error, done):
            self.assertEqual(done.returncode, 2)
            self.assertIn(ERRORS[error], done.stderr)
            found = self.recorded()
            self.assertIn(found, [None, *(frames[:n] for n in range(len(frames) + 1))])
            self.leaves_whole_files(whole | {"r.jsonl": self.contents().get("r.jsonl")})

        self.each_fault(command, check, ["rename"])

    def test_durable_recordings_sync_file_and_folder(self):
        self.assertEqual(self.count(DURABLE, "sync"), 2)
        self.assertEqual(self.count(RECORD, "sync"), 0)

    def test_a_recording_is_the_same_with_and_without_sync_except_for_the_command(self):
        self.succeed(*RECORD)
        plain = self.recorded()
        self.succeed(*DURABLE)
        self.assertEqual(self.recorded(), plain)
        self.assertEqual(len(plain), 40)
        self.succeed("replay", "out/r.jsonl", "--quiet")

    def test_durable_without_a_recording_is_refused(self):
        error = self.refused(*STREAM, "-o", "x.pcd", "--durable")
        self.assertIn("--durable: there is no --record", error)

    def test_a_kill_at_any_call_leaves_the_old_recording_or_the_complete_new_one(self):
        self.succeed(*RECORD)
        old = self.contents()["r.jsonl"]
        self.succeed(*DURABLE)
        new = self.contents()["r.jsonl"]
        self.assertNotEqual(old, new)

        def prepare():
            self.empty()
            (self.out / "r.jsonl").write_bytes(old)

        def check():
            found = self.contents()
            self.assertIn(found.pop("r.jsonl"), (old, new))
            self.assertLessEqual(len(found), 1)  # the temporary file
            self.assertTrue(all(name.startswith(".glidar-") for name in found), found.keys())
            self.succeed(*DURABLE)
            self.assertEqual(self.contents()["r.jsonl"], new)

        self.each_kill(DURABLE, prepare, check)


class Cache(FaultTest):
    """Here the folder of outputs is the cache."""

    def setUp(self):
        super().setUp()
        self.write("box.obj", BOX)
        self.command = ("render", "box.obj", "--cache-folder", "out", *SIZE, "-o", "x.pcd")
        self.empty()
        self.succeed(*self.command)
        self.whole = self.bytes_of("x.pcd")
        self.entry = self.contents()

    def test_every_failed_call_is_a_warning_and_the_result_is_right(self):
        self.assertEqual(len(self.entry), 1)

        def check(_, error, done):
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stderr, f"glidar: warning: .*the cache out cannot be written: .*{ERRORS[error]}")
            self.assertEqual(self.bytes_of("x.pcd"), self.whole)
            self.assertEqual(self.contents(), {})
            self.succeed(*self.command)
            self.assertEqual(self.contents().keys(), self.entry.keys())

        self.each_fault(self.command, check, ["open", "write", "rename"])

    def test_an_error_on_closing_stores_no_entry(self):
        self.empty()
        done = self.with_fault(self.command, "close", 1, "ENOSPC")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("the cache out cannot be written: No space left on device", done.stderr)
        self.assertEqual(self.bytes_of("x.pcd"), self.whole)
        self.assertEqual(self.contents(), {})

    def test_a_kill_at_any_call_leaves_no_invalid_entry(self):
        def check():
            self.succeed(*self.command)
            self.assertEqual(self.bytes_of("x.pcd"), self.whole)
            self.assertEqual(self.contents().keys(), self.entry.keys())

        self.each_kill(self.command, self.empty, check)


if __name__ == "__main__":
    if not library():
        skip(*NO_LIBRARY.split("; "))
    unittest.main()
