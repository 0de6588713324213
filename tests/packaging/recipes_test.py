#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The recipes in packaging/ and the workflow agree with the project: versions, dependencies, options, files and commands."""

import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from skipping import importing  # noqa: E402

with importing():
    import yaml

PACKAGING = ROOT / "packaging"
DEBIAN = PACKAGING / "debian"
# What a recipe leaves out of the group build of scripts/packages.txt.
SPEED = {"ccache"}
AT_RUN_TIME = {"libegl1", "libopengl0", "libgl1-mesa-dri", "libgl1"}
WINDOW = {"libglfw3-dev", "libimgui-dev"}  # Dear ImGui's pkg-config file is Debian's own
TOOLS = {"g++", "cmake", "ninja-build", "pkg-config"}


def read(path):
    return (ROOT / path).read_text(encoding="utf-8")


def packages(group):
    rows = [line.split() for line in read("scripts/packages.txt").splitlines() if line and not line.startswith("#")]
    return {row[0] for row in rows if row[1] == group}


def options():
    return set(re.findall(r"^(?:option|set)\((GLIDAR_\w+)", read("CMakeLists.txt"), re.MULTILINE))


def control():
    """{package or "source": its fields} of packaging/debian/control."""
    paragraphs = [dict(re.findall(r"(?m)^([\w-]+): ?(.*(?:\n .*)*)", text)) for text in read("packaging/debian/control").split("\n\n")]
    return {fields.get("Package", "source"): fields for fields in paragraphs}


def names(field):
    return [entry.split()[0] for entry in re.split(r",\s*", field) if entry.strip() and not entry.startswith("$")]


VERSION = re.search(r"project\(glidar VERSION (\S+)", read("CMakeLists.txt"))[1]


class Conda(unittest.TestCase):
    def setUp(self):
        self.text = read("packaging/conda-forge/recipe.yaml")
        self.recipe = yaml.safe_load(self.text)

    def test_it_is_of_this_version_and_of_these_sources(self):
        self.assertEqual(self.recipe["context"]["version"], VERSION)
        self.assertEqual((PACKAGING / "conda-forge" / self.recipe["source"]["path"]).resolve(), ROOT)
        self.assertTrue((ROOT / self.recipe["about"]["license_file"]).is_file())

    def test_it_requires_what_a_build_requires(self):
        named = re.findall(r"^    - .*  # (\S+)$", self.text, re.MULTILINE)
        self.assertEqual(len(named), len(set(named)))
        self.assertEqual(set(named), packages("build") - SPEED - WINDOW - {"libgl1", "libgl1-mesa-dri"})

    def test_it_requires_what_the_python_package_requires(self):
        project = read("pyproject.toml")
        for needed in re.search(r"requires = \[(.*)\]", project)[1].split(", "):
            self.assertIn(re.sub(r">=", " >=", needed.strip('"')), self.recipe["requirements"]["host"])
        self.assertIn(re.search(r'^dependencies = \["(.*)"\]', project, re.MULTILINE)[1].replace(">=", " >="), self.recipe["requirements"]["run"])


class Vcpkg(unittest.TestCase):
    def setUp(self):
        self.port = json.loads(read("packaging/vcpkg/glidar/vcpkg.json"))

    def test_it_is_of_this_version_and_of_these_sources(self):
        self.assertEqual((self.port["name"], self.port["version"]), ("glidar", VERSION))
        path = re.search(r'\{CMAKE_CURRENT_LIST_DIR\}/([./]+)"', read("packaging/vcpkg/glidar/portfile.cmake"))[1]
        self.assertEqual((PACKAGING / "vcpkg/glidar" / path).resolve(), ROOT)

    def test_it_requires_the_libraries_of_a_build(self):
        named = [entry["$debian"] for entry in self.port["dependencies"] if "host" not in entry]
        self.assertEqual(len(named), len(set(named)))
        self.assertEqual(set(named), packages("build") - SPEED - TOOLS - AT_RUN_TIME - WINDOW - {"libseccomp-dev"})


class Debian(unittest.TestCase):
    def test_it_is_of_this_version(self):
        self.assertEqual(re.match(r"glidar \((\S+)\)", read("packaging/debian/changelog"))[1], VERSION)

    def test_a_build_depends_on_the_packages_of_a_build(self):
        named = names(control()["source"]["Build-Depends"])
        self.assertEqual(named[0], "debhelper-compat")
        self.assertEqual(named[1:], sorted(packages("build") - SPEED - AT_RUN_TIME - {"g++"}))

    def test_packages_depend_on_what_those_of_cpack_depend_on(self):
        cpack = read("cmake/package.cmake").replace("\\\n", "")
        for package, field in (("glidar", "Recommends"), ("libglidar-dev", "Depends"), ("libglidar-dev", "Recommends")):
            component = {"glidar": "PROGRAM", "libglidar-dev": "DEVELOPMENT"}[package]
            wanted = re.findall(rf'{component}_PACKAGE_{field.upper()}\s+"([^"]+)"', cpack)
            self.assertEqual(set(names(control()[package][field])) - {"glidar"}, set(names(",".join(wanted))), package)

    def test_files_that_it_needs_are_there(self):
        lists = {path.stem for path in DEBIAN.glob("*.install")}
        self.assertEqual(lists, set(control()) - {"source"})
        self.assertTrue((DEBIAN / "copyright").samefile(PACKAGING / "copyright"))
        self.assertTrue((DEBIAN / "rules").stat().st_mode & 0o111)


class Workflow(unittest.TestCase):
    def setUp(self):
        self.text = read(".github/workflows/release.yml")
        self.jobs = yaml.safe_load(self.text)["jobs"]

    def test_its_commands_and_files_exist(self):
        shown = subprocess.run([ROOT / "dev", "help"], capture_output=True, text=True, check=True).stdout
        commands = re.findall(r"\./dev (\w+)", self.text)
        self.assertEqual(set(commands), {"test", "wheel", "package"})
        for command in commands:
            self.assertRegex(shown, rf"(?m)^  {command} ")
        self.assertTrue((ROOT / re.search(r"source/(tests/\S+)", self.text)[1]).is_file())

    def test_jobs_wait_only_for_jobs_and_steps_use_or_run_something(self):
        for name, job in self.jobs.items():
            needed = job.get("needs", [])
            self.assertLessEqual({needed} if isinstance(needed, str) else set(needed), set(self.jobs))
            for step in job["steps"]:
                self.assertEqual(len({"uses", "run"} & set(step)), 1, step)

    def test_wheels_are_tried_with_every_python_that_they_are_for(self):
        stable = re.search(r'wheel.py-api = "(cp\d+)"', read("pyproject.toml"))[1]
        for entry in self.jobs["try-wheels"]["strategy"]["matrix"]["include"]:
            own = "cp" + entry["python"].replace(".", "")
            self.assertEqual(entry["wheel"], f"{stable}-abi3" if own >= stable else f"{own}-{own}")


class Options(unittest.TestCase):
    def test_the_build_has_every_option_that_a_recipe_sets(self):
        files = ["packaging/conda-forge/recipe.yaml", "packaging/vcpkg/glidar/portfile.cmake", "packaging/debian/rules"]
        for file in files:
            given = re.findall(r"(?:-D|define\.)(GLIDAR_\w+)=", read(file))
            self.assertTrue(given, file)
            self.assertLessEqual(set(given), options(), file)


if __name__ == "__main__":
    unittest.main()
