# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The lists of keys in docs/ and the schemas beside the examples are those of the program."""

import importlib.util
import json
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def load_script():
    spec = importlib.util.spec_from_file_location("write_key_tables", ROOT / "scripts/write_key_tables.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run(*arguments):
    return subprocess.run(["glidar", "schema", *arguments], capture_output=True, text=True, check=False)


class Schema(unittest.TestCase):
    def schemas(self, kind):
        return json.loads(run(kind).stdout)

    def test_the_schemas_beside_presets_and_examples_are_up_to_date(self):
        for kind, name in load_script().SCHEMA_FILES.items():
            kept = (ROOT / name).read_text(encoding="utf-8")
            self.assertEqual(kept, run(kind).stdout, "run scripts/write_key_tables.py GLIDAR")
        self.assertEqual(run().stdout, run("sensor").stdout)

    def test_lists_in_the_documentation_are_up_to_date(self):
        script = load_script()
        lists = 0
        for page in sorted(ROOT.glob("docs/**/*.md")):
            text = page.read_text(encoding="utf-8")
            lists += text.count("<!-- keys:") + text.count("<!-- names of keys:")
            self.assertEqual(text, script.written(text, self.schemas), f"{page}: run scripts/write_key_tables.py GLIDAR")
        self.assertGreaterEqual(lists, 24)

    def test_a_list_that_differs_is_written_again(self):
        script = load_script()
        old = "a\n<!-- keys: sensor limits -->\nold\n<!-- end of keys -->\nb\n"
        new = script.written(old, self.schemas)
        self.assertIn("- `near_m` (0): shortest reported distance\n", new)
        self.assertNotIn("old", new)
        names = script.written(old.replace("keys: sensor", "names of keys: sensor"), self.schemas)
        self.assertIn("\n`near_m` (0), `far_m` (no limit), ", names)
        self.assertNotIn("shortest", names)

    def test_a_printed_table_has_units_defaults_and_limits(self):
        command = [sys.executable, "-B", ROOT / "scripts/write_key_tables.py", "glidar", "--print", "sensor", "limits"]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        self.assertIn("| `near_m` | m | 0 | from 0 | shortest reported distance |", done.stdout)

    def test_every_preset_refers_to_the_schema(self):
        for preset in sorted((ROOT / "sensors").glob("*.yaml")):
            first = preset.read_text(encoding="utf-8").splitlines()[0]
            self.assertEqual(first, "# yaml-language-server: $schema=sensor.schema.json", preset)

    def test_every_example_scene_refers_to_the_schema(self):
        scenes = [path for path in sorted((ROOT / "examples").glob("*.yaml"))
                  if "\nmodels:" in path.read_text(encoding="utf-8")]
        self.assertEqual(len(scenes), 6)
        for scene in scenes:
            first = scene.read_text(encoding="utf-8").splitlines()[0]
            self.assertEqual(first, "# yaml-language-server: $schema=scene.schema.json", scene)

    def test_an_unknown_kind_is_an_error_with_the_nearest(self):
        result = run("sensors")
        self.assertEqual(result.returncode, 2)
        self.assertIn("'sensors' has no schema; allowed: sensor, imu, scene, pose, motion, materials, surfaces; "
                      "did you mean 'sensor'?", result.stderr)


if __name__ == "__main__":
    unittest.main()
