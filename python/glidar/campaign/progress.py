# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The progress display: a bar with rate and remaining time on a terminal, else a line every ten seconds."""

import logging
import sys
import time

from glidar._printing import print_message

BAR = 24
LINE_EVERY_S = 10.0
DRAW_EVERY_S = 0.2
MAX_WARNINGS = 5


def duration(seconds):
    """65 -> "1:05", 3700 -> "1:01:40"."""
    minutes, s = divmod(int(round(seconds)), 60)
    hours, m = divmod(minutes, 60)
    return f"{hours}:{m:02}:{s:02}" if hours else f"{m}:{s:02}"


def line(done, total, failed, rate, columns=100):
    """The text of the display; `rate` in trials per second, 0 when unknown."""
    fraction = done / total if total else 1.0
    filled = int(BAR * fraction)
    text = f"[{'#' * filled}{'.' * (BAR - filled)}] {100 * fraction:5.1f} % {done}/{total} trials"
    if rate > 0:
        text += f", {rate:.4g}/s, {duration((total - done) / rate)} left"
    if failed:
        text += f", {failed} failed"
    return text[:columns]


class Progress:
    """Counts trials; the first `done` of them were complete before and do not count for the rate."""

    def __init__(self, total, done, quiet=False, stream=None):
        self.total, self.done, self.failed = total, done, 0
        self._before, self._start, self._drawn = done, time.monotonic(), -1e9
        self._reported = -1
        self._stream = stream or sys.stderr
        self._terminal = self._stream.isatty()
        self._quiet = quiet

    def advance(self, trials, failed):
        self.done += trials
        self.failed += failed
        self._draw()

    def rate(self):
        elapsed = time.monotonic() - self._start
        return (self.done - self._before) / elapsed if elapsed > 0 else 0.0

    def _draw(self, at_once=False):
        now = time.monotonic()
        every = DRAW_EVERY_S if self._terminal else LINE_EVERY_S
        if self._quiet or (now - self._drawn < every and not at_once):
            return
        self._drawn, self._reported = now, self.done
        text = line(self.done, self.total, self.failed, self.rate())
        self._stream.write(f"\r\x1b[K{text}" if self._terminal else f"{text}\n")
        self._stream.flush()

    def finish(self):
        if self.total and not self._quiet:
            if self._reported != self.done:
                self._draw(at_once=True)
            if self._terminal:
                self._stream.write("\n")


class Warnings(logging.Handler):
    """Prints the first few different warnings of the library; many files may cause the same one."""

    def __init__(self):
        super().__init__(logging.WARNING)
        self._reported = set()

    def emit(self, record):
        text = record.getMessage()
        if text in self._reported or len(self._reported) == MAX_WARNINGS:
            return
        self._reported.add(text)
        print_message(f"glidar: warning: {text}")
        if len(self._reported) == MAX_WARNINGS:
            print_message("glidar: further warnings of this process are not shown")


def print_warnings():
    """Prints warnings of the library to standard error, when no other handler exists."""
    logger = logging.getLogger("glidar")
    if not logger.handlers:
        logger.addHandler(Warnings())
