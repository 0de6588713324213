# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Files that a loss of power does not undo: their data is on the disk before they get their names, and the names are
on it before anything else lists them."""

import errno
import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from glidar import Error

THREADS = 8  # journals commit in one step what several threads wait for
FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}
#: POSIX lets a file system refuse to sync a folder (EINVAL); FUSE and network file systems do (ENOTSUP). Their names
#: last as far as they promise it themselves.
NO_FOLDERS = {errno.EINVAL, errno.ENOTSUP}


def _failure(path, error):
    remedy = ("make room and run the same command again: it goes on where it stopped" if error.errno in FULL else
              "check the disk and run the same command again: it goes on where it stopped; --no-durable does not sync")
    return Error(str(path), f"it cannot be synced to the disk: {error.strerror}", "", remedy)


def _sync(path, flags, accepted):
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_CLOEXEC | flags)
    except OSError as error:
        raise _failure(path, error) from None
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in accepted:
            raise _failure(path, error) from None
    finally:
        os.close(descriptor)


def sync_file(path):
    """Waits until a file's data is on the disk. Linux reports writes that failed before it was opened here too."""
    _sync(path, 0, ())


def sync_folder(path):
    """Waits until the names in a folder are on the disk."""
    _sync(path, os.O_DIRECTORY, NO_FOLDERS)


def _each(function, paths):
    if len(paths) < 2:
        for path in paths:
            function(path)
        return
    with ThreadPoolExecutor(min(THREADS, len(paths))) as threads:
        list(threads.map(function, paths))  # raises what they raise


def sync_files(paths):
    _each(sync_file, list(paths))


class Folders:
    """Folders within a root, which may be new: makes them, and syncs the names in them and their own."""

    def __init__(self, root):
        self._root = Path(os.path.abspath(root))
        self._made = []  # the root and folders above it that are new
        self._named = set()  # folders whose own names are on the disk

    def note_new(self):
        """Before the root is made: notes which folders above it are made with it."""
        if not self._made:
            self._made = [path for path in (self._root, *self._root.parents) if not path.exists()]

    def sync(self, folders):
        """Syncs the names in folders; once for each folder that this process writes to also its own, which another
        process may have made and not synced."""
        folders = {Path(os.path.abspath(folder)) for folder in folders}
        above = {path for folder in folders for path in self._unnamed(folder)}
        if self._root not in self._named:
            self._sync_root()
        _each(sync_folder, sorted(folders | {path.parent for path in above}))
        self._named |= above

    def _unnamed(self, folder):
        """A folder and those above it up to the root whose names are not known to be on the disk."""
        while folder != self._root and folder != folder.parent:
            if folder not in self._named:
                yield folder
            folder = folder.parent

    def _sync_root(self):
        for path in self._made:
            sync_folder(path.parent)
        # a root that was there may be new all the same, of a run that was killed; a folder above it that this user
        # must not read is of others, and so was there for longer
        if not self._made and os.access(self._root.parent, os.R_OK):
            sync_folder(self._root.parent)
        self._named.add(self._root)
