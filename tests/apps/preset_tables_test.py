# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The pages of docs/presets/ have every preset once, as the program lists it, and pictures of all of them."""

import importlib.util
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted((ROOT / "docs/presets").glob("*.md"))
MAX_WORDS = 1500
REMEDY = "run scripts/write_preset_table.py GLIDAR"


def load_script():
    spec = importlib.util.spec_from_file_location("write_preset_table", ROOT / "scripts/write_preset_table.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def text_of(picture, keyword):
    """The text chunk of a PNG with this keyword."""
    data = picture.read_bytes()
    at = 8
    while at < len(data):
        size, kind = int.from_bytes(data[at:at + 4]), data[at + 4:at + 8]
        key, _, text = data[at + 8:at + 8 + size].partition(b"\0")
        if kind == b"tEXt" and key == keyword.encode():
            return text.decode("latin-1")
        at += size + 12
    return ""


class PresetTables(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.script = load_script()
        cls.presets = cls.script.presets("glidar")

    def test_the_tables_are_up_to_date(self):
        for page in PAGES:
            text = page.read_text(encoding="utf-8")
            self.assertEqual(text, self.script.written(text, self.presets), f"{page}: {REMEDY}")

    def test_every_preset_has_one_row(self):
        rows = [line.split()[1] for page in PAGES for line in page.read_text(encoding="utf-8").splitlines()
                if line.startswith("| ") and not line.startswith("| name ")]
        self.assertEqual(sorted(rows), sorted(preset["name"] for preset in self.presets))

    def test_every_group_has_a_page_with_its_table(self):
        self.assertEqual([page.stem for page in PAGES], sorted(self.script.GROUPS))
        for page in PAGES:
            self.assertEqual(self.script.MARKED.findall(page.read_text(encoding="utf-8"))[0][0],
                             f"<!-- presets: {page.stem} -->\n")

    def test_the_pictures_show_the_presets_of_their_page(self):
        for group in self.script.GROUPS:
            names = [preset["name"] for preset in self.presets if self.script.group_of(preset) == group]
            picture = ROOT / f"docs/images/presets/{group}.png"
            self.assertEqual(text_of(picture, "Description").split(), names, f"{picture}: run scripts/plot_presets.py GLIDAR")

    def test_pages_are_short(self):
        for page in PAGES:
            self.assertLessEqual(len(page.read_text(encoding="utf-8").split()), MAX_WORDS, f"{page}: split its group")

    def test_a_table_that_differs_is_written_again(self):
        old = "a\n<!-- presets: lines -->\nold\n<!-- end of presets -->\nb\n"
        preset = {"name": "X", "sensor": "Maker X", "kind": "line_scan", "rows": 1, "cols": 9, "view_deg": [270.0, 0.0],
                  "rate_hz": 15.0, "near_m": 0.05, "far_m": None,
                  "detection": {"range_m": 5.0, "reflectance": 0.05, "documented": False}}
        new = self.script.written(old, [preset])
        self.assertIn("| X | Maker X | 1 x 9 | 270.0 x 0.0 | 15 | from 0.05 | 5 at 5 %\\* |", new)
        self.assertNotIn("old", new)


if __name__ == "__main__":
    unittest.main()
