# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Makes calls of a program fail that write to files below a folder, by the library of fault_injection.cpp, which is
preloaded. It is not built with sanitizers, whose libraries must come first."""

import hashlib
import mmap
import shutil
import struct
from pathlib import Path

CALLS = ("open", "write", "sync", "rename", "close")
ERRORS = {"EIO": "Input/output error", "ENOSPC": "No space left on device"}
NO_LIBRARY = "no fault injection with sanitizers; run it by ./dev test"
PATH_BYTES = 4096
STATE = struct.Struct(f"QQQ16s16s{PATH_BYTES}s{PATH_BYTES}s")  # as in fault_injection.cpp


def library():
    """The library, beside the built program that is found in PATH; None where it was not built."""
    program = shutil.which("glidar")
    path = Path(program).resolve().parents[2] / "tests" / "libglidar_fault_injection.so" if program else None
    return path if path and path.is_file() else None


def random_below(seed, counter, bound):
    """The same number again for the same arguments, evenly spread over range(bound)."""
    digest = hashlib.sha256(f"{seed} {counter}".encode()).digest()
    return int.from_bytes(digest[:8], "little") * bound >> 64


class Faults:
    """What goes wrong, and what came of it; for programs that run with `environment`."""

    def __init__(self, state_file, folder):
        self._folder = str(Path(folder).resolve())
        if not Path(state_file).exists():  # else it may be in use
            Path(state_file).write_bytes(bytes(STATE.size))
        with open(state_file, "r+b") as file:
            self._memory = mmap.mmap(file.fileno(), STATE.size)
        self.environment = {"LD_PRELOAD": str(library()), "GLIDAR_FAULT_STATE": str(Path(state_file).resolve())}

    def arm(self, call, at=0, error="EIO"):
        """The at-th such call from now on fails; 0: none, they are only counted."""
        STATE.pack_into(self._memory, 0, at, 0, 0, call.encode(), error.encode(), self._folder.encode(), b"")

    def disarm(self):
        self._memory[:] = bytes(STATE.size)

    @property
    def calls(self):
        return STATE.unpack_from(self._memory)[1]

    @property
    def hits(self):
        return STATE.unpack_from(self._memory)[2]

    @property
    def path(self):
        """The file of the call that failed first."""
        return STATE.unpack_from(self._memory)[6].rstrip(b"\0").decode()
