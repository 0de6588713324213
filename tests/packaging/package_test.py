#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The Debian packages that CPack makes of the build under test: fields, files, links, permissions. Whether they
install and run on a bare system is tried by `./dev package --try`."""

import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import check_binaries  # noqa: E402

BUILD = Path(shutil.which("glidar")).resolve().parents[2]
TIME_LIMIT_S = 300
DOCS = "usr/share/doc/glidar"


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True, timeout=TIME_LIMIT_S, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{command} ended with {done.returncode}:\n{done.stdout}\n{done.stderr}")
    return done.stdout


def tracked(folder):
    """Files of the repository below a folder, without those that are only for the build."""
    files = [path for path in (ROOT / folder).rglob("*") if path.is_file() and "__pycache__" not in path.parts]
    return {str(path.relative_to(ROOT)) for path in files if path.name != "CMakeLists.txt"}


class Package:
    """A package: its fields, and its files unpacked below a folder."""

    def __init__(self, file, folder):
        self.name = file.name
        text = run("dpkg-deb", "-f", file)
        self.fields = dict(re.findall(r"(?m)^([A-Za-z-]+): (.*(?:\n .*)*)", text))
        self.listing = run("dpkg-deb", "-c", file).splitlines()
        run("dpkg-deb", "-x", file, folder)
        self.folder = folder
        self.files = {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_symlink() or not p.is_dir()}

    def needs(self, field="Depends"):
        return {entry.split()[0]: entry for entry in self.fields[field].split(", ")}


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.work = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        config = BUILD / "CPackConfig.cmake"
        run("cpack", "--config", config, "-B", cls.work, "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=none")
        made = sorted(cls.work.glob("*.deb"))
        names = [re.match(r"[^_]+", file.name)[0] for file in made]
        if names != ["glidar", "libglidar-dev"]:
            raise AssertionError(f"packages: {made}")
        cls.program, cls.development = (
            Package(file, cls.work / name) for file, name in zip(made, names, strict=True)
        )
        cls.version = run("glidar", "--version").split()[1]
        cls.architecture = run("dpkg", "--print-architecture").strip()

    def test_fields_describe_the_package(self):
        for package, section in ((self.program, "science"), (self.development, "libdevel")):
            with self.subTest(package.name):
                self.assertEqual(package.fields["Version"], self.version)
                self.assertEqual(package.fields["Architecture"], self.architecture)
                self.assertEqual(package.fields["Section"], section)
                self.assertIn("GLIDAR developers", package.fields["Maintainer"])
                self.assertRegex(package.fields["Description"], r"\ASimulator of 3D sensors.*\n .*GLIDAR")
                name = f"{package.fields['Package']}_{self.version}_{self.architecture}.deb"
                self.assertEqual(package.name, name)
        self.assertIn("glidar[campaign]", self.program.fields["Description"])

    def test_programs_look_for_libraries_in_safe_places_only(self):
        for package, least in ((self.program, 2), (self.development, 0)):
            with self.subTest(package.name):
                count, complaints = check_binaries.check([package.folder], search_path_only=True)
                self.assertEqual(complaints, [])
                self.assertGreaterEqual(count, least)

    def test_program_depends_on_the_libraries_it_links_and_recommends_those_it_opens(self):
        needed = " ".join(self.program.needs())
        for library in ("libc6", "libstdc++6", "libtbb", "libassimp", "libyaml-cpp", "libzmq"):
            self.assertIn(library, needed)
        self.assertEqual(
            set(self.program.needs("Recommends")), {"libegl1", "libgl1", "libopengl0", "libgl1-mesa-dri"}
        )

    def test_library_depends_on_the_program_of_the_same_version(self):
        self.assertEqual(self.development.needs()["glidar"], f"glidar (= {self.version})")

    def test_library_depends_on_what_its_cmake_package_looks_for(self):
        """A pkg-config or CMake file of every dependency belongs to a package that is named."""
        config = (ROOT / "cmake/glidarConfig.cmake.in").read_text(encoding="utf-8")
        modules = re.findall(r"pkg_check_modules\(\w+ REQUIRED IMPORTED_TARGET (\S+)\)", config)
        self.assertGreater(len(modules), 3)
        for module in modules:
            folder = run("pkg-config", "--variable=pcfiledir", module).strip()
            owner = run("dpkg", "-S", f"{folder}/{module}.pc").split(":")[0]
            self.assertIn(owner, self.development.needs())
        for name in re.findall(r"find_dependency\((\w+)", config):
            known = {"PNG": "libpng-dev", "PkgConfig": "pkg-config", "ZLIB": "zlib1g-dev"}
            package = known.get(name, f"lib{name.lower().removesuffix('3')}")
            self.assertTrue(any(entry.startswith(package) for entry in self.development.needs()), name)

    def test_program_holds_programs_and_data(self):
        wanted = {"usr/bin/glidar", "usr/libexec/glidar/glidar-import"}
        for folder in ("materials", "models", "sensors"):
            wanted |= {f"usr/share/glidar/{file}" for file in tracked(folder)}
        self.assertLessEqual(wanted, self.program.files)
        for program in ("usr/bin/glidar", "usr/libexec/glidar/glidar-import"):
            self.assertTrue((self.program.folder / program).stat().st_mode & 0o111, program)

    def test_program_holds_all_documentation(self):
        wanted = {"README.md", "CHANGELOG.md", "CITATION.cff", "CONTRIBUTING.md", "LICENSE", "copyright"}
        wanted |= tracked("docs") | tracked("examples")
        self.assertLessEqual({f"{DOCS}/{file}" for file in wanted}, self.program.files)

    def test_links_of_the_installed_documentation_work(self):
        count = 0
        for page in (self.program.folder / DOCS).rglob("*.md"):
            for target in re.findall(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
                count += 1
                self.assertTrue((page.parent / target).exists(), f"{page}: {target}")
        self.assertGreater(count, 20)

    def test_library_holds_every_public_header_and_layer(self):
        headers = (ROOT / "glidar/public_headers.txt").read_text(encoding="utf-8").split("\n")
        wanted = {f"usr/include/{header}" for header in headers if header and not header.startswith("#")}
        self.assertGreater(len(wanted), 10)
        self.assertLessEqual(wanted, self.development.files)
        self.assertTrue(any(re.fullmatch(r"usr/lib/.*libglidar_core\.a", file) for file in self.development.files))
        for name in ("glidarConfig", "glidarSameSources"):
            self.assertTrue(any(file.endswith(f"cmake/glidar/{name}.cmake") for file in self.development.files), name)

    def test_no_file_is_in_both_or_only_for_the_build(self):
        self.assertEqual(self.program.files & self.development.files, set())
        for file in self.program.files | self.development.files:
            self.assertTrue(file.startswith("usr/"), file)
            self.assertNotRegex(file, r"__pycache__|\.pyc$|CMakeLists\.txt$|_tests?$")

    def test_the_debian_source_puts_every_file_into_the_same_package(self):
        for package, name in ((self.program, "glidar"), (self.development, "libglidar-dev")):
            folders = (ROOT / f"packaging/debian/{name}.install").read_text(encoding="utf-8").split()
            for file in package.files:
                self.assertTrue(file.startswith(tuple(f"{folder}/" for folder in folders)), f"{name}: {file}")

    def test_files_belong_to_root_and_only_root_writes_them(self):
        for line in self.program.listing + self.development.listing:
            self.assertRegex(line, r"^[-d][rwx-]{4}-[rwx-]{2}-[rwx-] root/root|^l[rwx]{9} root/root")

    def test_programs_search_libraries_in_no_folder_of_the_build(self):
        for program in ("usr/bin/glidar", "usr/libexec/glidar/glidar-import"):
            shown = run("readelf", "-d", self.program.folder / program)
            for path in re.findall(r"R(?:UN)?PATH.*\[(.*)\]", shown):
                for entry in path.split(":"):
                    self.assertTrue(entry.startswith("$ORIGIN/"), f"{program}: {path}")

    def test_programs_are_stripped(self):
        for program in ("usr/bin/glidar", "usr/libexec/glidar/glidar-import"):
            self.assertNotIn(".debug_info", run("readelf", "-S", self.program.folder / program))


if __name__ == "__main__":
    unittest.main()
