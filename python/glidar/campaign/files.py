# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Atomic files.

They are written in the campaign folder's `tmp` and renamed, so that a killed program leaves no partial results.
Durable files also survive power loss: their data is synced before the rename, and their folders after it.
"""

import contextlib
import hashlib
import json
import logging
import os
import secrets
import re
import shutil
import socket
import stat
from pathlib import Path

from glidar import Error
from glidar._errors import excerpt, printable
from glidar.campaign import durable as disk
from glidar.campaign.beneath import Inside

MAX_BYTES = 1 << 40  # of a file that is hashed or copied in blocks
MAX_JSON_BYTES = 1 << 30
MAX_JSON_LEVELS = 64
MAX_JSON_VALUES = 1 << 24
STRING = re.compile(rb'"(?:[^"\\]|\\.)*(?:"|\Z)', re.DOTALL)  # without a closing quote up to the end, in linear time
NO_BRACKETS = bytes(set(range(256)) - set(b"[]{}"))
MAX_PID = (1 << 31) - 1
TEMP_NAME = re.compile(r"(?P<host>.+)-(?P<pid>[0-9]{1,10})-[0-9a-f]{8}", re.ASCII | re.DOTALL)
LOGGER = logging.getLogger("glidar")


def note(text):
    """Logs a warning as one printable line, because it may quote files of others."""
    LOGGER.warning("%s", printable(text))


def write_error(path, error):
    """The error for a failed write; when the disk is full, it describes how to resume."""
    if error.errno in disk.NO_SPACE:
        return Error(str(path), f"it cannot be written: {os.strerror(error.errno)}",
                     "a disk with room for all outputs",
                     f"{disk.NO_SPACE[error.errno]} and run the same command again to resume")
    return Error(str(path), f"it cannot be written: {error.strerror or error}", "", "")


class TempFolder:
    """A folder in the campaign's `tmp` for files that one writer is writing. Files that are published from a durable
    one are synced to the disk."""

    def __init__(self, root, durable=False):
        self._place = Inside(root, "tmp", f"{socket.gethostname()}-{os.getpid()}-{secrets.token_hex(4)}")
        self.folder = self._place.path
        self.newest = self.folder  # the path returned last
        self.folders = disk.Folders(root) if durable else None
        self._count = 0

    def path(self, name):
        """A unique path to write to, with the name's suffix."""
        try:
            if self.folders:
                self.folders.record_new_folders()
            self._place.make_folder()
        except OSError as error:
            raise write_error(self.folder, error) from None
        self._count += 1
        self.newest = self.folder / f"{self._count}-{name}"
        return self.newest

    def sync_folders(self, folders):
        """If durable, waits until the names in the folders are on the disk."""
        if self.folders:
            self.folders.sync(folders)

    def remove(self):
        self._place.remove_tree()
        self._place.parent.remove_empty()


def _is_running(pid):
    """Whether the process exists and has not ended; an ended one may wait for its parent (a zombie)."""
    try:
        os.kill(pid, 0)
        state = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8", errors="replace")
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return state.rpartition(")")[2].split()[:1] not in (["Z"], ["X"])


@contextlib.contextmanager
def temp_folder(root, durable=False):
    """A TempFolder that is removed at the end, also after an exception."""
    own = TempFolder(root, durable)
    try:
        yield own
    finally:
        own.remove()


def _stale_pid(name):
    """The process of this machine that made a folder in `tmp`, if that has ended. Others keep theirs."""
    made = TEMP_NAME.fullmatch(name)
    if not made or int(made["pid"]) > MAX_PID:
        note(f"tmp/{excerpt(name)}: it is not a folder of glidar campaign, and stays")
        return None
    is_ours = made["host"] == socket.gethostname()
    return int(made["pid"]) if is_ours and not _is_running(int(made["pid"])) else None


def remove_stale_files(root):
    """Removes partial files that killed processes of this machine left; other processes may be writing."""
    tmp = Inside(root, "tmp")
    for folder in tmp.children():
        if _stale_pid(folder.name) is not None:
            folder.remove_tree()
    tmp.remove_empty()


def publish_all(temp, pairs, kept=()):
    """Renames finished files, given as pairs (written, final): a path in `temp` and a place in the campaign's folder.
    For a durable folder their data is on the disk before, and their names when this returns. The same then holds for
    `kept`, files that have their final names already."""
    if temp.folders:
        disk.sync_files([*(final.path for final in kept), *(written for written, _ in pairs)])
    for written, final in pairs:
        try:
            final.take(written)
        except OSError as error:
            raise write_error(final, error) from None
    temp.sync_folders({final.parent.path for final in [*kept, *(final for _, final in pairs)]})


def publish(temp, written, final):
    """Renames a finished file."""
    publish_all(temp, [(written, final)])


def prepare_bytes(temp, final, data):
    """Writes a file to be published; returns its pair for publish_all."""
    path = temp.path(final.name)
    try:
        with open(path, "wb") as file:
            file.write(data)
    except OSError as error:
        path.unlink(missing_ok=True)
        raise write_error(final, error) from None
    return path, final


def write_bytes(temp, final, data):
    """Writes a file atomically."""
    publish_all(temp, [prepare_bytes(temp, final, data)])


def json_bytes(value):
    """JSON with sorted keys and one entry per line, so that equal values give equal bytes."""
    return (json.dumps(value, indent=1, sort_keys=True, allow_nan=False) + "\n").encode()


def write_json(temp, final, value):
    write_bytes(temp, final, json_bytes(value))


def _mib(size):
    return f"{size / (1 << 20):.3g} MiB"


def open_input(path, max_bytes=MAX_BYTES):
    """Opens a regular file of at most `max_bytes` for reading: a path from the user, or a place in a campaign's folder.
    A pipe or device is rejected and cannot block."""
    flags = os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC
    try:
        descriptor = path.open(flags) if isinstance(path, Inside) else os.open(path, flags)
    except OSError as error:
        raise Error(str(path), f"it cannot be read: {error.strerror}", "a file that can be read", "") from None
    except ValueError as error:  # a zero byte or unencodable characters
        raise Error(excerpt(path), f"it is not a file name: {error}", "a path", "") from None
    file = os.fdopen(descriptor, "rb") if stat.S_ISREG(os.fstat(descriptor).st_mode) else None
    if file is None:
        os.close(descriptor)
        raise Error(str(path), "it is a folder, a pipe or a device", "a regular file", "")
    size = os.fstat(descriptor).st_size
    if size > max_bytes:
        file.close()
        raise Error(str(path), f"a file of {_mib(size)}", f"a file of at most {_mib(max_bytes)}", "")
    return file


def read_bytes(path, max_bytes):
    """The content of a regular file of at most `max_bytes`."""
    with open_input(path, max_bytes) as file:
        try:
            data = file.read(max_bytes + 1)
        except OSError as error:
            raise Error(str(path), f"it cannot be read: {error.strerror}", "", "") from None
    if len(data) > max_bytes:
        raise Error(str(path), "a file that grows while it is read", f"a file of at most {_mib(max_bytes)}", "")
    return data


def copy(source, target, max_bytes=MAX_BYTES):
    """Copies a regular file of at most `max_bytes`."""
    with open_input(source, max_bytes) as file, open(target, "wb") as copied:
        shutil.copyfileobj(file, copied, 1 << 20)


def _is_too_deep(data):
    """Whether JSON is nested too deeply for recursive code."""
    brackets = STRING.sub(b"", data).translate(None, NO_BRACKETS)
    for _ in range(MAX_JSON_LEVELS):
        if not brackets:
            return False
        brackets = brackets.replace(b"[]", b"").replace(b"{}", b"")
    return bool(brackets)


def _no_number(word):
    raise ValueError(f"{word} is not a JSON number")


def _has_more_values(data, max_values):
    """Whether JSON has more values than that, keys not counted: each follows a comma or begins a list or map."""

    def count(text):
        return 1 + sum(map(text.count, (b",", b"[", b"{")))

    return count(data) > max_values and count(STRING.sub(b"", data)) > max_values


def read_json(path, max_values=MAX_JSON_VALUES):
    """The content of a JSON file; raises Error when it cannot be read or parsed."""
    data = read_bytes(path, MAX_JSON_BYTES)
    if _has_more_values(data, max_values):
        raise Error(str(path), f"JSON of more than {max_values} values", "fewer", "")
    try:
        value = json.loads(data, parse_constant=_no_number)
        is_too_deep = _is_too_deep(data)
    except RecursionError:
        is_too_deep = True
    except ValueError as error:
        raise Error(str(path), f"it is not JSON: {excerpt(error)}", "", "") from None
    if is_too_deep:
        raise Error(str(path), "JSON nested too deeply", f"about {MAX_JSON_LEVELS} levels", "")
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
