# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""docs/sensors.md has every preset once, as the program lists it, and pictures of all of them."""

import importlib.util
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
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

    def test_the_list_is_up_to_date(self):
        text = (ROOT / self.script.PAGE).read_text(encoding="utf-8")
        self.assertEqual(len(self.script.MARKED.findall(text)), 1)
        self.assertEqual(text, self.script.written(text, self.presets), REMEDY)

    def test_the_list_has_every_preset_once(self):
        names = [name for line in self.script.lines_of(self.presets) for part in line.split(". ", 1)[1].split("; ")
                 for name in part.split(": ")[1].split(", ")]
        self.assertEqual(sorted(names), sorted(preset["name"] for preset in self.presets))

    def test_the_page_shows_the_picture_of_every_group(self):
        text = (ROOT / self.script.PAGE).read_text(encoding="utf-8")
        for group in self.script.GROUPS:
            self.assertIn(f"(images/presets/{group}.png)", text)

    def test_the_pictures_show_the_presets_of_their_page(self):
        for group in self.script.GROUPS:
            names = [preset["name"] for preset in self.presets if self.script.group_of(preset) == group]
            picture = ROOT / f"docs/images/presets/{group}.png"
            self.assertEqual(text_of(picture, "Description").split(), names, f"{picture}: run scripts/plot_presets.py GLIDAR")

    def test_a_list_that_differs_is_written_again(self):
        preset = {"name": "X", "sensor": "Maker X", "kind": "line_scan", "rows": 1}
        new = self.script.written("a\n<!-- presets -->\nold\n<!-- end of presets -->\nb\n", [preset])
        self.assertIn("- one line: 2D, airborne. Maker: X\n", new)
        self.assertNotIn("old", new)


if __name__ == "__main__":
    unittest.main()
