#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The link check accepts correct links and names the line of every broken one."""

import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import check_links  # noqa: E402

MISSING = "docs/" + "missing.md"  # in two parts: the check reads this file too


class CheckLinks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write("pages/other.md", "# Other page\n## Key `a_b`: what, and why?\n## Twice\n## Twice\n")

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text, encoding="utf-8")

    def complaints(self, text, path="pages/page.md"):
        self.write(path, text)
        return check_links.check_file(self.root, path)

    def test_accepts_links_to_files_folders_anchors_and_addresses(self):
        self.assertEqual(self.complaints("# Here\n[a](other.md) [b](../pages) [c](#here) [d](https://example.org/x.md#y)\n"), [])
        self.assertEqual(self.complaints("[a](other.md#key-a_b-what-and-why) [b](other.md#twice-1)\n"), [])

    def test_reports_a_missing_file_with_its_line(self):
        self.assertEqual(self.complaints("# Page\n\nsee [it](gone.md)\n"), ["pages/page.md:3: no such file: gone.md"])

    def test_reports_a_missing_image(self):
        self.assertEqual(len(self.complaints("![a plot](images/gone.png)\n")), 1)

    def test_reports_a_missing_anchor(self):
        self.assertEqual(
            self.complaints("see [it](other.md#gone)\n"), ["pages/page.md:1: no heading for the anchor: other.md#gone"]
        )
        self.assertEqual(len(self.complaints("see [it](other.md#twice-2)\n")), 1)
        self.assertEqual(len(self.complaints("see [it](#gone)\n")), 1)

    def test_ignores_code(self):
        self.assertEqual(self.complaints("```\n# no heading\n[a](gone.md)\n```\nuse `[a](gone.md)`\n"), [])
        self.assertEqual(len(self.complaints("```\n# no heading\n```\n[a](#no-heading)\n")), 1)

    def test_reports_a_page_that_source_code_names_but_does_not_exist(self):
        self.assertEqual(self.complaints(f"// see {MISSING}\n", "a.cpp"), [f"a.cpp:1: no such page: {MISSING}"])
        self.assertEqual(self.complaints("// see pages/other.md.\n", "a.cpp"), [])

    def test_reads_no_binary_files(self):
        (self.root / "a.png").write_bytes(b"\x89PNG\xff")
        self.assertEqual(check_links.check_file(self.root, "a.png"), [])

    def test_all_links_of_this_repository_work(self):
        pages = [path.relative_to(ROOT) for path in (ROOT / "docs").rglob("*.md")] + [Path("README.md")]
        self.assertEqual([one for page in pages for one in check_links.check_page(ROOT, page)], [])


if __name__ == "__main__":
    unittest.main()
