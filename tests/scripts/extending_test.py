# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The example of docs/internals/extending.md: its patch applies, keeps the rules of includes, compiles and works, and
touches four files."""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from skipping import IN_CTEST, skip  # noqa: E402

LIBRARIES = os.environ.get("GLIDAR_LIBRARIES", "")
READER = ["io/config/field_json", "io/config/provenance", "io/config/yaml_field_reader", "io/config/yaml_reader",
          "io/files/input_file"]
KEYS_TEST = """
TEST(Example, KeysAreReadAndWritten) {
  glidar::NoiseStep step;
  const auto read = [&](const std::string& text) {
    glidar::read_struct(glidar::read_yaml_text("noise", text), step);
  };
  read("{type: range_outliers, probability: 0.1, spread_m: 0.3}");
  const auto written = glidar::write_struct(glidar::FieldVisitor::Mode::document, step);
  EXPECT_EQ(written.dump(), R"({"type":"range_outliers","probability":0.1,"spread_m":0.3})");
  try {
    read("{type: range_outliers, probability: 0.1, spred_m: 1}");
    FAIL() << "an unknown key was accepted";
  } catch (const glidar::Error& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'spread_m'?"), std::string::npos);
  }
}
"""


def patch_text():
    page = (ROOT / "docs/internals/extending.md").read_text(encoding="utf-8")
    return re.search(r"```diff\n(.*?)```", page, re.DOTALL)[1]


def unit_text(folder):
    """All sources of the noise steps, the reader, the writer and the tests as one translation unit."""
    sources = sorted((folder / "glidar/sensor/noise").glob("*.cpp")) + [folder / f"glidar/{name}.cpp" for name in READER]
    sources += [folder / "tests/sensor/noise/noise_trace_test.cpp"]
    return "".join(f'#include "{source}"\n' for source in sources) + KEYS_TEST


class NoiseStepExample(unittest.TestCase):
    def test_it_touches_four_files(self):
        self.assertEqual(len(re.findall(r"^\+\+\+ ", patch_text(), re.MULTILINE)), 4)

    def test_it_applies_compiles_and_passes_its_test(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            shutil.copytree(ROOT / "glidar", folder / "glidar")
            shutil.copytree(ROOT / "tests/sensor", folder / "tests/sensor")
            subprocess.run(["patch", "-p1", "--quiet"], input=patch_text(), text=True, cwd=folder, check=True)
            subprocess.run([sys.executable, "-B", ROOT / "scripts/check_includes.py", folder], check=True)
            (folder / "unit.cpp").write_text(unit_text(folder), encoding="utf-8")
            command = shlex.split(os.environ["GLIDAR_CXX"]) + [
                "-std=c++20", "-ffp-contract=off", *shlex.split(os.environ["GLIDAR_CXX_FLAGS"]), "-O0", "-I.", "-Itests",
                *[f"-isystem{path}" for path in os.environ["GLIDAR_INCLUDES"].split(",")], "unit.cpp", "-o", "example",
                *LIBRARIES.split(","), "-lyaml-cpp", "-lfmt", "-ltbb", "-lgtest", "-lgtest_main", "-pthread"]
            subprocess.run(command, cwd=folder, check=True)
            subprocess.run(["./example"], cwd=folder, check=True)


if __name__ == "__main__":
    if not LIBRARIES:
        skip("GLIDAR_LIBRARIES is not set", IN_CTEST)
    unittest.main()
