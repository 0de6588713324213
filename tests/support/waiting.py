# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Waiting for what a test needs: the only place of the Python tests that sleeps."""

import re
import time

# Machines may be very busy; a test that goes well never waits so long. Half of CTest's limit for a test program, so that
# the message of a wait appears before it.
MAX_WAIT_S = 300
PAUSE_S = 0.02


def wait_until(condition, what, process=None, pause_s=PAUSE_S, max_s=MAX_WAIT_S):
    """The first true value of condition(). Fails after max_s, and once the process has ended without it."""
    end = time.monotonic() + max_s
    while True:
        has_ended = process is not None and process.poll() is not None
        value = condition()
        if value:
            return value
        if has_ended:
            raise AssertionError(f"{process.args} ended with {process.returncode} before {what}")
        if time.monotonic() > end:
            raise AssertionError(f"waited {max_s} s in vain for {what}")
        time.sleep(pause_s)


def pauses(what):
    """For a generator that is asked again and again until something else happens: fails after MAX_WAIT_S."""
    end = time.monotonic() + MAX_WAIT_S
    while time.monotonic() < end:
        time.sleep(PAUSE_S)
        yield None
    raise AssertionError(f"waited {MAX_WAIT_S} s in vain for {what}")


def let_time_pass(seconds):
    """For tests of what must not happen meanwhile, or that act at any time during other work: tests that cannot fail
    because a machine is slow."""
    time.sleep(seconds)


def wait_for_line(stream, pattern):
    """Reads lines of a program's output until one matches; that line."""
    read = []
    for line in stream:
        if re.search(pattern, line):
            return line
        read.append(line)
    raise AssertionError(f"the program ended without a line '{pattern}':\n{''.join(read)}")
