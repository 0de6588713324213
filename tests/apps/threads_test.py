#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""--threads N changes neither results nor messages, also when there are fewer processors than threads."""

import unittest

from cli_support import CliTest

THREADS = (1, 2, 3, 5, 64)


class Threads(CliTest):
    def rendered(self, threads, *arguments):
        done = self.succeed("render", "builtin:asteroid", *arguments, "--threads",
                            str(threads), "--columns", "all", "-o", "a.npz")
        self.assertEqual(done.stderr, "", f"{threads} threads")
        return self.bytes_of("a.npz")

    def test_give_the_same_bytes_and_no_warning(self):
        for renderer in ("rays", "raster", "auto"):
            view = ("-w", "96", "--height", "64", "--renderer", renderer)
            first, *others = (self.rendered(threads, *view) for threads in THREADS)
            for threads, other in zip(THREADS[1:], others):
                self.assertEqual(other, first, f"{renderer}, {threads} threads")

    def test_give_the_same_bytes_with_pulsed_light_and_no_warning(self):
        first, *others = (self.rendered(threads, "--sensor", "VLP-16", "--eye", "3,0,0") for threads in THREADS)
        for threads, other in zip(THREADS[1:], others):
            self.assertEqual(other, first, f"{threads} threads")


if __name__ == "__main__":
    unittest.main()
