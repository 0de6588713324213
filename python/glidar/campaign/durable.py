# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Files that survive power loss: their data is synced before they get their names, and the names are synced before
another file lists them."""

import errno
import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from glidar import Error

THREADS = 8  # a journal commits the syncs of several threads together
#: What makes room for a file, by the error of a write.
NO_SPACE = {errno.ENOSPC: "make room", errno.EDQUOT: "make room",
            errno.EFBIG: "raise the limit on the size of files (ulimit -f)"}
#: POSIX lets a file system reject the sync of a folder (EINVAL); FUSE and network file systems do (ENOTSUP). The
#: durability of their names depends on the file system.
FOLDER_SYNC_UNSUPPORTED = {errno.EINVAL, errno.ENOTSUP}


def _failure(path, error):
    remedy = (f"{NO_SPACE[error.errno]} and run the same command again to resume" if error.errno in NO_SPACE else
              "check the disk and run the same command again to resume; --no-durable does not sync")
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
    """Waits until a file's data is on the disk. On Linux it also reports writes that failed before the file was opened."""
    _sync(path, 0, ())


def sync_folder(path):
    """Waits until the names in a folder are on the disk."""
    _sync(path, os.O_DIRECTORY, FOLDER_SYNC_UNSUPPORTED)


def _for_each(function, paths):
    if len(paths) < 2:
        for path in paths:
            function(path)
        return
    with ThreadPoolExecutor(min(THREADS, len(paths))) as threads:
        list(threads.map(function, paths))  # raises their exceptions


def sync_files(paths):
    _for_each(sync_file, list(paths))


class Folders:
    """Syncs the names in folders below a root, and the names of the folders themselves, which may be new."""

    def __init__(self, root):
        self._root = Path(os.path.abspath(root))
        self._new_folders = []  # the root and its parents that are new
        self._synced = set()  # folders whose own names are on the disk

    def record_new_folders(self):
        """Records, before the root is created, which of its parents will be created with it."""
        if not self._new_folders:
            self._new_folders = [path for path in (self._root, *self._root.parents) if not path.exists()]

    def sync(self, folders):
        """Syncs the names in folders. The first sync of a folder by this process also syncs the folder's own name,
        because another process may have created it without a sync."""
        folders = {Path(os.path.abspath(folder)) for folder in folders}
        above = {path for folder in folders for path in self._unsynced(folder)}
        if self._root not in self._synced:
            self._sync_root()
        _for_each(sync_folder, sorted(folders | {path.parent for path in above}))
        self._synced |= above

    def _unsynced(self, folder):
        """A folder and its parents up to the root whose names are not known to be on the disk."""
        while folder != self._root and folder != folder.parent:
            if folder not in self._synced:
                yield folder
            folder = folder.parent

    def _sync_root(self):
        for path in self._new_folders:
            sync_folder(path.parent)
        # An existing root may still be unsynced, from a run that was killed. A parent that this user cannot read
        # belongs to others and so has existed for longer.
        if not self._new_folders and os.access(self._root.parent, os.R_OK):
            sync_folder(self._root.parent)
        self._synced.add(self._root)
