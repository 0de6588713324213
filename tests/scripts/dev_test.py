#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""`./dev` installs exactly the packages that are missing, and installs GLIDAR in the given folder. It runs in a separate copy, and in PATH there are only
programs that record how they were called, so that nothing of the machine changes."""

import os
import pty
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TIME_LIMIT_S = 300
REAL = "bash awk sort paste mkdir grep tail dirname nproc env cat xargs realpath cmp chmod ln".split()

# dpkg-query knows what the file `states` lists, one package and its status per line; one package may have several,
# of several architectures.
DPKG_QUERY = """#!/bin/bash
[[ "$1 $2" == "-W -f" ]] || exit 2
known=0
while read -r package status; do
  if [[ $package == "$4" ]]; then
    text=${3//'${db:Status-Status}'/$status}
    printf "${text//%/%%}"
    known=1
  fi
done <"$STATES"
((known == 0)) || exit 0
echo "dpkg-query: no packages found matching $4" >&2
exit 1
"""
RECORD = """#!/bin/bash
printf '%s\\n' "${0##*/} $*" >>"$CALLS"
"""
RECORD_PYTHON = """#!/bin/bash
printf '%s\\n' "$0 $* [$glidar_ROOT]" >>"$CALLS"
"""
RUN_AND_RECORD = RECORD + '"$@"\n'
NOTHING = "#!/bin/bash\n"
PACKAGES = """# comment
bare        lint  # unknown to dpkg
purged      lint  # known, because another package names it
removed     lint
unpacked    lint
present     lint
elsewhere   test  # of another group
"""
STATES = """purged not-installed
removed config-files
unpacked half-installed
present installed
"""
WAIT = "-o DPkg::Lock::Timeout=600"  # for another installation
UPDATE = f"apt-get update -q {WAIT}"
INSTALL = f"apt-get install -q -y {WAIT} --no-install-recommends "


class Dev(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "scripts").mkdir()
        (self.folder / "bin").mkdir()
        shutil.copy(ROOT / "dev", self.folder / "dev")
        self.states = STATES
        self.packages = PACKAGES
        self.settings = {}  # further variables of the environment
        for name in REAL:
            (self.folder / "bin" / name).symlink_to(shutil.which(name))
        for name in ("git", "clang-format"):  # what `./dev format` runs once its packages are there
            self.program(name, NOTHING)
        self.program("dpkg-query", DPKG_QUERY)
        self.program("apt-get", RECORD)
        self.user(0)

    def program(self, name, text):
        path = self.folder / "bin" / name
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755)

    def user(self, number):
        self.program("id", f"#!/bin/bash\n[[ $* == -u ]] && echo {number}\n")

    def environment(self, path=""):
        return {
            "PATH": f"{self.folder / 'bin'}:{path}",
            "HOME": str(self.folder / "home"),
            "CALLS": str(self.folder / "calls"),
            "STATES": str(self.folder / "states"),
            **self.settings,
        }

    def dev(self, *arguments, path=""):
        """Runs ./dev, by default `format`, with `path` added to PATH; gives its exit status, its output, its errors and the calls it made, in order."""
        (self.folder / "scripts/packages.txt").write_text(self.packages, encoding="utf-8")
        (self.folder / "states").write_text(self.states, encoding="utf-8")
        calls = self.folder / "calls"
        calls.write_text("", encoding="utf-8")
        done = subprocess.run(
            [self.folder / "bin/bash", "dev", *(arguments or ["format"])],
            cwd=self.folder,
            env=self.environment(path),
            capture_output=True,
            text=True,
            timeout=TIME_LIMIT_S,
            check=False,
        )
        return done.returncode, done.stdout, done.stderr, calls.read_text(encoding="utf-8").splitlines()

    def test_installs_every_package_of_the_group_that_is_not_installed(self):
        status, output, errors, calls = self.dev()
        self.assertEqual((status, errors), (0, ""))
        self.assertEqual(calls, [UPDATE, INSTALL + "bare purged removed unpacked"])
        self.assertIn("installing 4 packages: bare purged removed unpacked", output)

    def test_a_package_of_two_architectures_is_there_when_one_is_installed(self):
        self.packages = "one lint\n"
        for states in (("installed", "installed"), ("installed", "config-files"), ("not-installed", "installed")):
            with self.subTest(states):
                self.states = "".join(f"one {state}\n" for state in states)
                self.assertEqual(self.dev()[3], [])
        self.states = "one not-installed\none config-files\n"
        self.assertEqual(self.dev()[3], [UPDATE, INSTALL + "one"])

    def test_each_status_alone_decides(self):
        self.packages = "one lint\n"
        for state in ("not-installed", "config-files", "half-installed", "unpacked", "half-configured"):
            with self.subTest(state):
                self.states = f"one {state}\n"
                self.assertEqual(self.dev()[3], [UPDATE, INSTALL + "one"])

    def test_calls_nothing_when_all_are_installed(self):
        self.states = "".join(f"{name} installed\n" for name in ("bare", "purged", "removed", "unpacked", "present"))
        self.assertEqual(self.dev(), (0, "", "", []))

    def test_a_user_installs_by_sudo(self):
        self.user(1000)
        self.program("sudo", RUN_AND_RECORD)
        status, _, errors, calls = self.dev()
        self.assertEqual((status, errors), (0, ""))
        install = INSTALL + "bare purged removed unpacked"
        self.assertEqual(
            calls, [f"sudo {UPDATE}", UPDATE, f"sudo env DEBIAN_FRONTEND=noninteractive {install}", install]
        )

    def test_neither_root_nor_sudo_names_the_command_to_ask_for(self):
        self.user(1000)
        status, output, errors, calls = self.dev()
        self.assertEqual((status, output, calls), (1, "", []))
        self.assertEqual(
            errors, "dev: neither root nor sudo; ask for: apt-get install bare purged removed unpacked\n"
        )

    def test_another_system_is_told_all_packages_of_the_group(self):
        (self.folder / "bin/dpkg-query").unlink()
        status, output, errors, calls = self.dev()
        self.assertEqual((status, output, calls), (1, "", []))
        self.assertEqual(
            errors,
            "dev: this is not Debian or Ubuntu; install what these packages hold: "
            "bare present purged removed unpacked\n",
        )

    def test_a_failed_installation_ends_with_its_output(self):
        self.program("apt-get", '#!/bin/bash\n[[ $1 == update ]] && exit 0\necho "E: no space left"\nexit 100\n')
        status, _, errors, _ = self.dev()
        self.assertEqual(status, 1)
        self.assertIn("E: no space left", errors)
        self.assertIn("apt-install failed; all its output is in", errors)

    def test_an_unknown_command_is_named(self):
        status, _, errors, calls = self.dev("frmat")
        self.assertEqual((status, calls), (1, []))
        self.assertIn("usage: ./dev COMMAND", errors)
        self.assertIn("dev: unknown command: frmat", errors)

    def test_packages_that_cannot_be_installed_are_reported_and_tests_run_all_the_same(self):
        self.packages = "present build\n"
        for name in ("cmake", "ninja", "ctest"):
            self.program(name, RECORD)
        for name in ("", "_rosbags", "_dds", "_packets", "_slam"):
            venv = self.folder / f"build/venv{name.replace('_', '-')}"
            (venv / "bin").mkdir(parents=True)
            (self.folder / f"scripts/requirements{name}.txt").write_text("any==1\n", encoding="utf-8")
            if name not in ("_packets", "_slam"):
                shutil.copy(self.folder / f"scripts/requirements{name}.txt", venv / "requirements.txt")
                continue
            (venv / "bin/pip").write_text("#!/bin/bash\necho no wheel\nexit 1\n", encoding="utf-8")
            (venv / "bin/pip").chmod(0o755)
        packets, odometry = "the test of packets with other decoders is skipped", "the test of odometry with other programs is skipped"
        for options, reported in (((), [packets]), (("--all",), [packets, odometry])):
            status, output, errors, calls = self.dev("test", *options)
            self.assertEqual(status, 0)
            self.assertIn("no wheel", errors)
            self.assertEqual([line for line in (packets, odometry) if line in output], reported)
            self.assertTrue(calls[-1].startswith("ctest --preset dev"), calls)

    def make_environment(self, folder, text=RECORD_PYTHON):
        """A virtual environment whose Python only records."""
        python = folder / "bin/python"
        python.parent.mkdir(parents=True)
        python.write_text(text, encoding="utf-8")
        python.chmod(0o755)

    def install(self, *arguments, path=""):
        """./dev install with CMake and ninja that only record."""
        self.packages = "present build\n"
        for name in ("cmake", "ninja"):
            self.program(name, RECORD)
        return self.dev("install", *arguments, path=path)

    def install_with_python(self, prefix, *arguments, **settings):
        """The same where the prefix already has an environment, and the folder that CMake makes."""
        self.make_environment(prefix / "lib/glidar/python")
        (prefix / "bin").mkdir()
        return self.install(*arguments, **settings)

    def test_install_goes_to_the_home_folder_and_names_the_line_for_path(self):
        prefix = self.folder / "home/.local"
        status, output, errors, calls = self.install("--no-python")
        self.assertEqual((status, errors), (0, ""))
        self.assertIn(f"cmake --preset release -DCMAKE_INSTALL_PREFIX={prefix}", calls)
        self.assertEqual(calls[-1], "cmake --install build/release")
        self.assertIn(f"installed in {prefix}", output)
        self.assertIn(f"""{prefix}/bin is not in PATH; add it, also in ~/.profile:
  export PATH="{prefix}/bin:$PATH"
""", output)

    def test_a_terminal_shows_the_steps_of_a_build_until_it_ends(self):
        self.install("--no-python")  # once, so that the packages are known
        self.program("ninja", "#!/bin/bash\nexec {pause}<> <(:)\necho '[3/4] Building'\n"
                              "until [[ -e seen ]]; do read -r -t 0.1 -u $pause; done\nexit 0\n")
        terminal, end = pty.openpty()
        with os.fdopen(terminal, "rb", buffering=0) as screen:
            with subprocess.Popen([self.folder / "bin/bash", "dev", "install", "--no-python"], cwd=self.folder, env=self.environment(),
                                  stdin=subprocess.DEVNULL, stdout=end, stderr=end) as process:
                os.close(end)
                shown = b""
                while b"building (release): step 3 of 4" not in shown:
                    shown += screen.read(1000)
                (self.folder / "seen").touch()
                try:
                    while read := screen.read(1000):
                        shown += read
                except OSError:  # the other end is closed
                    pass
        self.assertEqual(process.returncode, 0, shown)
        self.assertIn(b"\r\x1b[Kbuilt (release) in ", shown)

    def test_a_build_that_fails_names_its_log(self):
        self.program("ninja", "#!/bin/bash\necho '[3/4] Building'\nexit 1\n")
        self.packages = "present build\n"
        self.program("cmake", RECORD)
        status, output, errors, _ = self.dev("install", "--no-python")
        self.assertEqual((status, output), (1, ""))
        self.assertEqual(errors, f"dev: build-release failed; all its output is in {self.folder}/build/log/build-release.log\n")

    def test_install_takes_a_folder_and_is_silent_where_path_has_it(self):
        prefix = self.folder / "my programs"
        status, output, _, calls = self.install_with_python(prefix, "my programs", path=prefix / "bin")
        self.assertEqual(status, 0)
        self.assertIn(f"cmake --preset release -DCMAKE_INSTALL_PREFIX={prefix}", calls)
        self.assertNotIn("PATH", output)

    def test_install_puts_the_python_package_into_an_environment_of_its_own(self):
        """pip finds the installed library, and glidar-python runs the environment's Python."""
        prefix = self.folder / "my programs"
        status, _, errors, calls = self.install_with_python(prefix, "my programs")
        self.assertEqual((status, errors), (0, ""))
        venv = prefix / "lib/glidar/python"
        self.assertEqual(calls[-1], f"{venv}/bin/python -m pip install --disable-pip-version-check . [{prefix}]")
        self.assertEqual((prefix / "bin/glidar-campaign").readlink(), venv / "bin/glidar-campaign")
        calls = self.folder / "calls"
        calls.write_text("", encoding="utf-8")
        subprocess.run([prefix / "bin/glidar-python", "a b.py"], env=self.environment(), timeout=TIME_LIMIT_S, check=True)
        self.assertEqual(calls.read_text(encoding="utf-8"), f"{venv}/bin/python a b.py []\n")

    def test_install_puts_the_python_package_into_the_active_environment(self):
        prefix, active = self.folder / "home/.local", self.folder / "active"
        self.make_environment(active)
        self.settings = {"VIRTUAL_ENV": str(active)}
        status, output, errors, calls = self.install()
        self.assertEqual((status, errors), (0, ""))
        self.assertEqual(calls[-1], f"{active}/bin/python -m pip install --disable-pip-version-check . [{prefix}]")
        self.assertNotIn("glidar-python", output)
        self.assertIn(f"{active}/bin/python -m pip uninstall glidar", output)

    def test_install_names_what_an_active_environment_lacks(self):
        active = self.folder / "active"
        self.make_environment(active, "#!/bin/bash\necho No module named pip >&2\nexit 1\n")
        self.settings = {"VIRTUAL_ENV": str(active)}
        status, _, errors, _ = self.install()
        self.assertEqual(status, 1)
        self.assertIn("No module named pip", errors)
        self.assertIn(f"run {active}/bin/python -m ensurepip, or omit the Python package: ./dev install --no-python", errors)

    def test_install_names_an_option_that_it_does_not_know(self):
        status, _, errors, calls = self.install("--no-pyton")
        self.assertEqual((status, calls), (1, []))
        self.assertEqual(errors, "dev: install takes --no-python and a folder, not --no-pyton\n")

    def test_install_refuses_what_cannot_become_a_folder(self):
        (self.folder / "file").write_text("", encoding="utf-8")
        status, _, errors, calls = self.install("file/below")
        self.assertEqual((status, calls), (1, []))
        self.assertIn(f"{self.folder}/file is not a folder that you may write to; install elsewhere", errors)

    def test_package_names_an_argument_that_it_does_not_know(self):
        status, _, errors, calls = self.dev("package", "--tyr")
        self.assertEqual((status, calls), (1, []))
        self.assertEqual(errors, "dev: package takes no argument or --try [SUITE], not --tyr\n")


if __name__ == "__main__":
    unittest.main()
