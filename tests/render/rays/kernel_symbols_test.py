#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Kernels for one instruction set define no function that the linker could share with the rest of the program.

The linker keeps one copy of an inline function. If it were the one with AVX-512, other processors would stop at it.
"""

import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from skipping import IN_CTEST, skip

OBJECTS = [path for path in os.environ.get("GLIDAR_KERNEL_OBJECTS", "").split(",") if path]
DEFINED = re.compile(r"^[0-9a-f]+ [A-Zuvw] (.*)$")


def defined_in(path):
    done = subprocess.run(["nm", "-C", "--defined-only", path], capture_output=True, text=True, check=True)
    return [found[1] for found in map(DEFINED.match, done.stdout.splitlines()) if found]


class KernelSymbols(unittest.TestCase):
    def test_are_all_in_the_namespace_of_the_instruction_set(self):
        for path in OBJECTS:
            layer, isa = re.search(r"glidar_(\w+)_kernel_(\w+)\.dir", path).groups()
            space = {"render": "rays", "sensor": "stereo"}[layer]
            names = defined_in(path)
            self.assertTrue(any("Kernel" in name for name in names), path)
            others = [name for name in names if f"glidar::{space}::{isa}::" not in name and not name.startswith(".")]
            self.assertEqual(others, [], path)


if __name__ == "__main__":
    if not OBJECTS:
        skip("GLIDAR_KERNEL_OBJECTS is not set", "build it by GCC for x86-64, without sanitizers, and " + IN_CTEST)
    unittest.main()
