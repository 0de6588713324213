#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/soak.py, shortened, and whether it sees what it looks for."""

import contextlib
import io
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests/support")]

from skipping import importing

with importing():
    import matplotlib  # noqa: F401
    import numpy as np
    import zmq  # noqa: F401

import soak


def findings(**counts):
    return soak.Findings(requests=9, vanished=9, nonsense=9, clouds=9, **counts)


HELD_NOTHING = [{"held_bytes": 0}, {}]


def memory(mb_per_s):
    times = np.arange(0, 3600, 1.0)
    return np.column_stack([times, 30 + mb_per_s * times, np.full_like(times, 30)])


class SoakTest(unittest.TestCase):
    def test_ten_seconds_go_well(self):
        said, complained = io.StringIO(), io.StringIO()
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(said), \
                contextlib.redirect_stderr(complained):
            picture = Path(folder, "soak.png")
            code = soak.main(["--seconds", "10", "--picture", str(picture)])
            self.assertEqual(picture.read_bytes()[:4], b"\x89PNG")
        self.assertEqual(code, 0, said.getvalue() + complained.getvalue())
        self.assertIn("readers took", said.getvalue())
        self.assertNotIn(" 0 missed", said.getvalue())  # the one that never reads

    def test_a_reply_of_other_bytes_is_a_fault(self):
        with tempfile.TemporaryDirectory() as folder:
            run = soak.Soak(folder, 10)
            run.first_replies[3] = b"something else"
            run.run()
            run.end()
        self.assertIn("request 3 has another reply than before", " ".join(run.findings.errors))

    def test_a_program_that_dies_is_a_fault(self):
        with tempfile.TemporaryDirectory() as folder:
            run = soak.Soak(folder, 60)
            run.stream.kill()
            run.stream.wait()
            run.run()
            run.end()
        self.assertEqual(run.findings.errors, ["glidar ended before its time"])

    def test_memory_that_grows_is_a_fault(self):
        self.assertEqual(soak.find_errors(findings(), memory(0.0), HELD_NOTHING), [])
        self.assertEqual(soak.find_errors(findings(), memory(0.9 * soak.MEMORY_TOLERANCE_MB / 1800), HELD_NOTHING), [])
        errors = soak.find_errors(findings(), memory(1.1 * soak.MEMORY_TOLERANCE_MB / 1800), HELD_NOTHING)
        self.assertEqual(len(errors), 1)
        self.assertIn("lock-step: memory grew by 2.2 MB", errors[0])

    def test_bytes_held_for_clients_that_have_left_are_a_fault(self):
        stats = [{"held_bytes": soak.HELD_TOLERANCE_BYTES + 1}, {}]
        self.assertEqual(soak.find_errors(findings(), memory(0.0), stats),
                         [f"lock-step: it holds {soak.HELD_TOLERANCE_BYTES + 1} bytes for clients that have left"])

    def test_statistics_without_held_bytes_are_a_fault(self):
        self.assertEqual(soak.find_errors(findings(), memory(0.0), [{}, {}]),
                         ["lock-step: its statistics have no held_bytes"])

    def test_memory_returns_to_its_level_after_attackers(self):
        said, complained = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complained):
            code = soak.main(["--seconds", "10", "--hostile"])
        self.assertEqual(code, 0, said.getvalue() + complained.getvalue())
        self.assertIn("cut off or refused", said.getvalue())

    def test_a_client_that_does_nothing_is_a_fault(self):
        self.assertEqual(soak.find_errors(soak.Findings(), memory(0.0), HELD_NOTHING), ["a client did nothing"])


if __name__ == "__main__":
    unittest.main()
