#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Dictionaries of the fuzzers."""

import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import fuzz_dictionary  # noqa: E402


class Dictionaries(unittest.TestCase):
    def test_keys_and_words_of_sensor_files_are_those_of_the_schema(self):
        words = fuzz_dictionary.dictionary("sensor")
        for word in ("optics", "wedge_mirror", "range_gaussian", "leading_edge"):
            self.assertIn(f'"{word}"', words)

    def test_every_fuzzer_with_a_dictionary_has_a_corpus(self):
        names = {file.stem for file in (ROOT / "tests/fuzz/dictionaries").glob("*.dict")}
        names |= {*fuzz_dictionary.SAME, *fuzz_dictionary.SCHEMAS}
        self.assertLessEqual(names, {file.stem for file in (ROOT / "tests/fuzz/corpus").glob("*.zip")})

    def test_fuzzers_without_a_dictionary_get_none(self):
        self.assertEqual(fuzz_dictionary.dictionary("bag_records"), [])


if __name__ == "__main__":
    unittest.main()
