#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The measured weight of a small tree is what its files contain."""

import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import measure_weight  # noqa: E402

TREE = {
    "glidar/public_headers.txt": "glidar/open.hpp\n",
    "glidar/open.hpp": "struct Open {\n};\n",
    "glidar/inner.hpp": "enum class Inner : int { a };\n",
    "glidar/shared.hpp": "class Declared;\n",
    "glidar/a.cpp": "#include <glidar/inner.hpp>\n#include <glidar/open.hpp>\n#include <glidar/shared.hpp>\n",
    "apps/b.cpp": '#include "../glidar/none.hpp"\n#include <glidar/shared.hpp>\n',
    "glidar/inner.cpp": "#include <glidar/inner.hpp>\n",
    "docs/" + "page.md": "four words are here\n",
    "tests/t.cpp": "#include <glidar/open.hpp>\n",
}


class MeasureWeight(unittest.TestCase):
    def test_a_private_header_with_one_user_besides_its_own_source_is_found(self):
        self.assertEqual(measure_weight.lone_headers(TREE), {"glidar/inner.hpp": "glidar/a.cpp"})

    def test_lines_files_types_and_words_are_counted(self):
        values = {what: value for what, value, _ in measure_weight.measures(TREE)}
        self.assertEqual(values["product lines"], 10)
        self.assertEqual(values["tracked files"], 9)
        self.assertEqual(values["lines per library file"], 2)
        self.assertEqual(values["types per 1,000 library lines"], 250.0)
        self.assertEqual(values["words in docs/"], 4)


if __name__ == "__main__":
    unittest.main()
