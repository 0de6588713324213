# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""An installed package alone: what it brings along is found, nothing of a source tree is used, and no compiler.
Run by scripts/make_wheel.sh with the Python of an environment that holds the wheel."""

import shutil
import subprocess
import sys
from pathlib import Path

import glidar

package = Path(glidar.__file__).parent
assert package.is_relative_to(sys.prefix), package

scene = glidar.Scene(package / "share/glidar/models/satellite/satellite.obj")
frame = glidar.simulate(scene, "VLP-16", glidar.look_at([9, 0, 0], [0, 0, 0], boresight="x"), seed=1)
assert frame.hits > 0
assert glidar.surface_names()
frame.save("scan.pcd")

# open files of the process: all libraries are from the package or the system
mapped = {line.split()[-1] for line in Path("/proc/self/maps").read_text().splitlines() if ".so" in line}
foreign = [m for m in mapped if any(word in m for word in ("rays", "tbb", "yaml-cpp", "libzip")) and sys.prefix not in m]
assert not foreign, foreign

program = Path(sys.prefix) / "bin/glidar"


def run(*arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


assert run("--version").splitlines()[0].endswith(glidar.__version__)
assert "VLP-16" in run("sensors")
assert "--executor" in run("campaign", "run", "--help")  # by glidar-campaign, next to the program
run("render", str(package / "share/glidar/models/satellite/satellite.obj"), "-o", "cloud.pcd")
loaded = subprocess.run([package / "bin/glidar"], env={"LD_TRACE_LOADED_OBJECTS": "1"}, capture_output=True, text=True, check=True).stdout
assert "libc.so" in loaded and "not found" not in loaded, loaded
assert shutil.which("cc") is None and shutil.which("c++") is None, "a compiler is in PATH"
print(f"glidar {glidar.__version__} works in {sys.prefix}: {frame}")
