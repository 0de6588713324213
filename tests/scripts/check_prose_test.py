#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The check of wording reports every discouraged word with its line, reads only prose."""

import io
import sys
import tempfile
import unittest
from contextlib import redirect_stdout
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import check_prose  # noqa: E402


def complaints(text, path="page.md"):
    return check_prose.check_text(path, text)


class Markdown(unittest.TestCase):
    def test_plain_text_passes(self):
        self.assertEqual(complaints("# Limits\nThe standard output is a data sheet; the ground truth is printed.\n"), [])

    def test_a_discouraged_word_is_reported_with_its_line_and_replacement(self):
        self.assertEqual(complaints("# Page\n\nA matt wall.\n"), ["page.md:3: 'matt'; use: diffuse"])

    def test_case_does_not_matter(self):
        self.assertEqual(len(complaints("Told by the sensor.\n")), 1)

    def test_every_pattern_finds_something(self):
        samples = (
            "tells|said|stands|standing still|lies|goes with|goes on|comes along|matt|square on|hair|twins|"
            "who is slow|by itself|asked for|judged|settled|hugs|sightings|lamp|the sheet|the truth|a fault|story|anew|"
            "but for|in the place of|to the bit|to and fro|the way of the 2015 program|one learns|laid out|likewise|if not said"
        )
        found = "\n".join(complaints(samples))
        for rule, advice in check_prose.RULES:
            self.assertRegex(samples, rule)
            self.assertIn(f"use: {advice}", found)

    def test_code_and_links_are_not_prose(self):
        for text in ("```text\nmatt surface\n```\n", "use `matt_share` or `matt`\n", "The output:\n\n    matt\n\n    matt\n",
                     "[a wall](matt.md)\n", "<!-- matt -->\n", "--matt and matt_share and told()\n"):
            self.assertEqual(complaints(text), [], text)

    def test_text_behind_code_keeps_its_line(self):
        self.assertEqual(complaints("```\na\n```\n`b` is\nmatt\n"), ["page.md:5: 'matt'; use: diffuse"])


class Sources(unittest.TestCase):
    def test_comments_and_strings_of_cpp_are_read(self):
        text = '// told\nint told = 1; /* it\n lies */ auto a = "matt wall", b = "lamp";\nauto c = R"(\nhair)";\n'
        self.assertEqual([one.split(";")[0] for one in complaints(text, "a.cpp")],
                         ["a.cpp:1: 'told'", "a.cpp:3: 'lies'", "a.cpp:3: 'matt'", "a.cpp:5: 'hair'"])

    def test_comments_and_strings_of_python_are_read(self):
        text = 'told = 1  # told\n"""It\nlies."""\nprint(f"matt {told}")\n'
        self.assertEqual([one.split(";")[0] for one in complaints(text, "a.py")],
                         ["a.py:1: 'told'", "a.py:3: 'lies'", "a.py:4: 'matt'"])


class Files(unittest.TestCase):
    def run_check(self, *arguments):
        """The exit code and output for a folder with a clean page, an unclean page and an unclean source."""
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "good.md").write_text("A diffuse wall.\n", encoding="utf-8")
            (folder / "bad.md").write_text("A matt wall.\n", encoding="utf-8")
            (folder / "bad.py").write_text("# told\n", encoding="utf-8")
            with mock.patch.multiple(check_prose, ROOT=folder,
                                     tracked=lambda suffixes: [file for file in ("bad.md", "bad.py", "good.md")
                                                               if Path(file).suffix in suffixes]), \
                    redirect_stdout(io.StringIO()) as out:
                code = check_prose.main(list(arguments))
            return code, [line.split(";")[0] for line in out.getvalue().splitlines()]

    def test_pages_are_checked_without_options(self):
        self.assertEqual(self.run_check(), (1, ["bad.md:1: 'matt'"]))

    def test_sources_are_checked_with_the_option(self):
        self.assertEqual(self.run_check("--sources"), (1, ["bad.md:1: 'matt'", "bad.py:1: 'told'"]))

    def test_files_that_are_named_are_checked_alone(self):
        self.assertEqual(self.run_check("good.md"), (0, []))
        self.assertEqual(self.run_check("bad.py"), (1, ["bad.py:1: 'told'"]))

    def test_the_check_skips_the_files_that_list_the_words(self):
        self.assertTrue(all((ROOT / path).is_file() for path in check_prose.WORD_LISTS))
        self.assertFalse(check_prose.WORD_LISTS & set(check_prose.tracked({".py"})))


if __name__ == "__main__":
    unittest.main()
