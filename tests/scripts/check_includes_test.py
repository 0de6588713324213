#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The include check lets a good tree pass and names the line of every kind of bad include."""

import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import check_includes  # noqa: E402

GOOD = {
    "glidar/public_headers.txt": "# comment\nglidar/glidar.hpp\nglidar/core/pose.hpp\nglidar/io/sink.hpp\n",
    "glidar/glidar.hpp": "#pragma once\n#include <glidar/core/pose.hpp>\n#include <glidar/io/sink.hpp>\n",
    "glidar/core/pose.hpp": "#pragma once\n#include <Eigen/Core>\n#include <vector>\n",
    "glidar/core/pose.cpp": "#include <glidar/core/pose.hpp>\n#include <cmath>\n",
    "glidar/io/sink.hpp": "#pragma once\n#include <glidar/core/pose.hpp>\n",
    "glidar/io/png_impl.hpp": "#pragma once\n#include <png.h>\n",
    "glidar/io/sink.cpp": "#include <glidar/io/sink.hpp>\n\n#include <glidar/io/png_impl.hpp>\n",
    "glidar/render/renderer.hpp": "#pragma once\n#include <glidar/core/pose.hpp>\n",
    "glidar/simulate/simulate.hpp": "#pragma once\n#include <glidar/render/renderer.hpp>\n",
    "apps/glidar/main.cpp": '#include "verbs.hpp"\n#include <glidar/simulate/simulate.hpp>\n',
}


class CheckIncludes(unittest.TestCase):
    def complaints(self, changes):
        """The output of the check for the good tree with these files replaced."""
        with tempfile.TemporaryDirectory() as folder:
            for path, text in {**GOOD, **changes}.items():
                file = Path(folder) / path
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8")
            return check_includes.check_tree(Path(folder))

    def expect(self, changes, *parts):
        found = self.complaints(changes)
        self.assertEqual(len(found), 1, found)
        for part in parts:
            self.assertIn(part, found[0])

    def test_good_tree_passes(self):
        self.assertEqual(self.complaints({}), [])

    def test_core_must_not_include_upward(self):
        text = "#include <glidar/core/pose.hpp>\n\n#include <glidar/io/sink.hpp>\n"
        self.expect({"glidar/core/pose.cpp": text}, "glidar/core/pose.cpp:3:", "core must not include io")

    def test_layers_must_not_include_sideways(self):
        text = "#pragma once\n#include <glidar/io/sink.hpp>\n"
        self.expect({"glidar/render/renderer.hpp": text}, "render must not include io")

    def test_nobody_includes_the_simulation_from_below(self):
        text = "#include <glidar/simulate/simulate.hpp>\n"
        self.expect({"glidar/motion/spin.cpp": text}, "motion must not include simulate")

    def test_unknown_layer_is_told(self):
        text = "#include <glidar/core/pose.hpp>\n"
        self.expect({"glidar/extra/a.cpp": text}, "layer extra is not known")

    def test_public_header_must_not_include_third_party(self):
        text = "#pragma once\n#include <embree3/rtcore.h>\n"
        self.expect({"glidar/core/pose.hpp": text}, "pose.hpp:2:", "<embree3/rtcore.h>")

    def test_public_header_must_not_include_a_private_one(self):
        text = "#pragma once\n#include <glidar/io/png_impl.hpp>\n"
        self.expect({"glidar/io/sink.hpp": text}, "glidar/io/png_impl.hpp, which is not in")

    def test_listed_header_must_exist(self):
        text = GOOD["glidar/public_headers.txt"] + "glidar/core/gone.hpp\n"
        self.expect({"glidar/public_headers.txt": text}, "glidar/core/gone.hpp does not exist")

    def test_listed_header_must_be_part_of_the_umbrella(self):
        text = GOOD["glidar/public_headers.txt"] + "glidar/render/renderer.hpp\n"
        self.expect({"glidar/public_headers.txt": text}, "glidar/render/renderer.hpp is not included by glidar/glidar.hpp")

    def test_header_needs_pragma_once(self):
        self.expect({"glidar/core/pose.hpp": "// #pragma once\n"}, "#pragma once is missing")

    def test_own_header_comes_first(self):
        text = "#include <cmath>\n#include <glidar/core/pose.hpp>\n"
        self.expect({"glidar/core/pose.cpp": text}, "the first include must be <glidar/core/pose.hpp>")

    def test_own_headers_are_not_included_by_relative_path(self):
        text = '#include <glidar/core/pose.hpp>\n#include "pose.hpp"\n'
        self.expect({"glidar/core/pose.cpp": text}, "must be included as <glidar/LAYER/FILE.hpp>")

    def test_missing_header_is_told(self):
        text = "#include <glidar/core/nothing.hpp>\n"
        self.expect({"apps/glidar/a.cpp": text}, "<glidar/core/nothing.hpp> does not exist")

    def test_this_project_passes(self):
        self.assertEqual(check_includes.check_tree(ROOT), [])


if __name__ == "__main__":
    unittest.main()
