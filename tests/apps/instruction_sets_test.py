#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The instruction set, forced by GLIDAR_ISA, changes no byte of a result."""

import pathlib
import unittest

from cli_support import CliTest

NAMES = ("baseline", "avx2", "avx512")
STREET = pathlib.Path(__file__).parents[2] / "examples" / "street.yaml"


class InstructionSets(CliTest):
    def render(self, name, *arguments):
        self.environment["GLIDAR_ISA"] = name
        return self.run_program("render", *arguments, "--columns", "all", "-o", "a.npz")

    def usable(self):
        names = []
        for name in NAMES:
            done = self.render(name, "builtin:box", "--renderer", "rays")
            if done.returncode == 0:
                names.append(name)
            else:
                self.assertIn(f"this processor has no kernel '{name}'", done.stderr)
        self.assertIn("baseline", names)
        return names

    def rendered(self, name, *arguments):
        done = self.render(name, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.bytes_of("a.npz")

    def test_give_the_same_bytes(self):
        usable = self.usable()
        camera = ("builtin:asteroid", "-w", "128", "--height", "96")
        for arguments in ((*camera, "--renderer", "rays"), (*camera, "--renderer", "raster"),
                          ("builtin:torus", "--sensor", "VLP-16", "--eye", "3,0,0"), (str(STREET), )):
            first, *others = (self.rendered(name, *arguments) for name in usable)
            for name, other in zip(usable[1:], others):
                self.assertEqual(other, first, f"{arguments[0]}, {name}")

    def test_unknown_ones_are_errors_that_list_the_known_ones(self):
        done = self.render("sse9", "builtin:box", "--renderer", "rays")
        self.assertEqual(done.returncode, 2)
        self.assertIn("environment variable GLIDAR_ISA: this processor has no kernel 'sse9'; allowed: baseline",
                      done.stderr)


if __name__ == "__main__":
    unittest.main()
