# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Files that are there whole or not at all.

They are written in the campaign folder's `tmp` and renamed, so that a program killed at any moment
leaves nothing behind that looks like a result. What is written durably is also there after a loss of
power: data is synced before the rename, folders after it.
"""

import contextlib
import glob
import hashlib
import json
import os
import secrets
import re
import shutil
import socket
import stat
from pathlib import Path

from glidar import Error
from glidar._errors import excerpt
from glidar.campaign import durable as disk

MOST_BYTES = 1 << 40  # of a file that is hashed or copied piece by piece
MOST_JSON_BYTES = 1 << 30
MOST_JSON_LEVELS = 64
STRING = re.compile(rb'"(?:[^"\\]|\\.)*"')
NO_BRACKETS = bytes(set(range(256)) - set(b"[]{}"))


def write_error(path, error):
    """What a fault of writing says; where space ran out, that the campaign can go on."""
    if error.errno in disk.FULL:
        return Error(str(path), f"it cannot be written: {os.strerror(error.errno)}",
                     "a disk with room for all outputs",
                     "make room and run the same command again: it goes on where it stopped")
    return Error(str(path), f"it cannot be written: {error.strerror or error}", "", "")


class Scratch:
    """A folder for what is being written, of this writer alone, within the campaign's `tmp`. What is published from a
    durable one is synced to the disk."""

    def __init__(self, root, durable=False):
        name = f"{socket.gethostname()}-{os.getpid()}-{secrets.token_hex(4)}"
        self.folder = Path(root) / "tmp" / name
        self.newest = self.folder  # the path given last
        self.folders = disk.Folders(root) if durable else None
        self._count = 0

    def path(self, name):
        """A path to write to; unique, with the name's ending."""
        try:
            if self.folders:
                self.folders.note_new()
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise write_error(self.folder, error) from None
        self._count += 1
        self.newest = self.folder / f"{self._count}-{name}"
        return self.newest

    def sync_folders(self, folders):
        """Of a durable one: waits until the names in folders are on the disk."""
        if self.folders:
            self.folders.sync(folders)

    def remove(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        _remove_empty(self.folder.parent)


def _is_running(pid):
    """Whether there is such a process that has not ended; one that has may wait for its parent (a zombie)."""
    try:
        os.kill(pid, 0)
        state = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8", errors="replace")
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return state.rpartition(")")[2].split()[:1] not in (["Z"], ["X"])


@contextlib.contextmanager
def scratch(root, durable=False):
    """A Scratch that is gone at the end, whatever happens."""
    own = Scratch(root, durable)
    try:
        yield own
    finally:
        own.remove()


def remove_leftovers(root):
    """Takes away what killed processes of this machine left half written; others may be writing."""
    tmp = Path(root) / "tmp"
    for folder in tmp.glob(f"{glob.escape(socket.gethostname())}-*-*"):
        pid = folder.name.rsplit("-", 2)[1]
        if pid.isdigit() and not _is_running(int(pid)):
            shutil.rmtree(folder, ignore_errors=True)
    _remove_empty(tmp)


def _remove_empty(folder):
    try:
        folder.rmdir()  # fails while others write there
    except OSError:
        pass


def publish_all(scratch, pairs, kept=()):
    """Renames finished files to their places: (written, final) pairs. From a durable scratch their data is on the disk
    before, and their names when this returns; `kept`: files for which the same holds then, that have their names."""
    if scratch.folders:
        disk.sync_files([*kept, *(written for written, _ in pairs)])
    for written, final in pairs:
        try:
            Path(final).parent.mkdir(parents=True, exist_ok=True)
            os.replace(written, final)
        except OSError as error:
            raise write_error(final, error) from None
    scratch.sync_folders({Path(final).parent for final in [*kept, *(final for _, final in pairs)]})


def publish(scratch, written, final):
    """Renames a finished file to its place."""
    publish_all(scratch, [(written, final)])


def prepare_bytes(scratch, final, data):
    """Writes a file to be published, and gives the pair for publish_all."""
    path = scratch.path(Path(final).name)
    try:
        with open(path, "wb") as file:
            file.write(data)
    except OSError as error:
        path.unlink(missing_ok=True)
        raise write_error(final, error) from None
    return path, final


def write_bytes(scratch, final, data):
    """Writes a file whole or not at all."""
    publish_all(scratch, [prepare_bytes(scratch, final, data)])


def json_bytes(value):
    """JSON with its keys in order and one entry a line, so that equal values have equal bytes."""
    return (json.dumps(value, indent=1, sort_keys=True, allow_nan=False) + "\n").encode()


def write_json(scratch, final, value):
    write_bytes(scratch, final, json_bytes(value))


def open_input(path, most=MOST_BYTES):
    """A regular file of at most so many bytes, opened for reading. A pipe or device is refused, and cannot block."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    except OSError as error:
        raise Error(str(path), f"it cannot be read: {error.strerror}", "a file that can be read", "") from None
    except ValueError as error:  # a zero byte, or letters that no file name can have
        raise Error(excerpt(path), f"it is no name of a file: {error}", "a path", "") from None
    file = os.fdopen(descriptor, "rb") if stat.S_ISREG(os.fstat(descriptor).st_mode) else None
    if file is None:
        os.close(descriptor)
        raise Error(str(path), "it is a folder, a pipe or a device", "a regular file", "")
    size = os.fstat(descriptor).st_size
    if size > most:
        file.close()
        raise Error(str(path), f"a file of {size >> 20} MiB", f"a file of at most {most >> 20} MiB", "")
    return file


def read_bytes(path, most):
    """The content of a regular file of at most so many bytes."""
    with open_input(path, most) as file:
        try:
            data = file.read(most + 1)
        except OSError as error:
            raise Error(str(path), f"it cannot be read: {error.strerror}", "", "") from None
    if len(data) > most:
        raise Error(str(path), "a file that grows while it is read", f"a file of at most {most >> 20} MiB", "")
    return data


def copy(source, target):
    """Copies a regular file."""
    with open_input(source) as file, open(target, "wb") as copied:
        shutil.copyfileobj(file, copied, 1 << 20)


def _is_too_deep(data):
    """Whether JSON is nested too deeply for what works through it by recursion."""
    brackets = STRING.sub(b"", data).translate(None, NO_BRACKETS)
    for _ in range(MOST_JSON_LEVELS):
        if not brackets:
            return False
        brackets = brackets.replace(b"[]", b"").replace(b"{}", b"")
    return bool(brackets)


def _no_number(word):
    raise ValueError(f"{word} is no number in JSON")


def read_json(path):
    """What a JSON file holds; every fault of it is an Error."""
    data = read_bytes(path, MOST_JSON_BYTES)
    try:
        value = json.loads(data, parse_constant=_no_number)
        is_too_deep = _is_too_deep(data)
    except RecursionError:
        is_too_deep = True
    except ValueError as error:
        raise Error(str(path), f"it is no JSON: {excerpt(error)}", "", "") from None
    if is_too_deep:
        raise Error(str(path), "JSON nested too deeply", f"about {MOST_JSON_LEVELS} levels", "")
    return value


def hash_bytes(data):
    return hashlib.sha256(data).hexdigest()


def hash_file(path):
    """SHA-256 of a file, hexadecimal, as sha256sum prints it."""
    try:
        with open_input(path) as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise Error(str(path), f"it cannot be read: {error.strerror}", "", "") from None
