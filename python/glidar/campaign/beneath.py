# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Files of a campaign's folder, which may come from others.

They are opened by descriptor, step by step from the folder, and no link is followed: neither in the file's place nor in
that of a folder above it. So nothing outside the folder is read, written or removed.
"""

import contextlib
import errno
import os
import shutil
import stat
from pathlib import Path

from glidar import Error

FOLDER = os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC
MAX_TRIES = 100  # of making a folder that other processes remove; each fails only between two system calls


class Inside:
    """The place of a file or folder in a campaign's folder. It is no path: open() and os functions do not take it."""

    __slots__ = ("root", "parts")

    def __init__(self, root, *parts):
        self.root, self.parts = Path(root), parts

    def __truediv__(self, name):
        """A place below; `name` has parts between '/'. Raises Error when it could lead elsewhere."""
        parts = tuple(str(name).split("/"))
        if any(part in ("", ".", "..") or "\0" in part for part in parts):
            raise Error(f"{self}/{name}", "it is not the name of a file in this folder", "", "")
        return Inside(self.root, *self.parts, *parts)

    def __str__(self):
        return str(self.path)

    def __repr__(self):
        return f"Inside({str(self)!r})"

    def __eq__(self, other):
        return isinstance(other, Inside) and self.path == other.path

    def __hash__(self):
        return hash(self.path)

    @property
    def path(self):
        """For messages, and for files that this process has just made there."""
        return self.root.joinpath(*self.parts)

    @property
    def name(self):
        return self.parts[-1] if self.parts else self.root.name

    @property
    def stem(self):
        return self.name.rpartition(".")[0] or self.name

    @property
    def relative(self):
        return "/".join(self.parts)

    @property
    def parent(self):
        return Inside(self.root, *self.parts[:-1])

    # reading

    def open(self, flags, mode=0o666):
        """A descriptor. Raises FileNotFoundError, other OSErrors, and Error for a link."""
        with self.parent.opened() as folder:
            return self._step(folder, self.name, flags | os.O_NOFOLLOW | os.O_CLOEXEC, mode)

    @contextlib.contextmanager
    def opened(self, makes=False):
        """The descriptor of this folder; `makes`: it and those above it are made where they are missing."""
        if makes:
            self.root.mkdir(parents=True, exist_ok=True)
        folder = os.open(self.root, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)  # the user has named it
        try:
            for part in self.parts:
                if makes:
                    with contextlib.suppress(FileExistsError):
                        os.mkdir(part, dir_fd=folder)
                below = self._step(folder, part, FOLDER)
                os.close(folder)
                folder = below
            yield folder
        finally:
            os.close(folder)

    def _step(self, folder, name, flags, mode=0o666):
        try:
            return os.open(name, flags, mode, dir_fd=folder)
        except OSError as error:
            if error.errno in (errno.ELOOP, errno.ENOTDIR, errno.EMLINK):
                self._reject_link(folder, name)
            raise

    def _reject_link(self, folder, name):
        with contextlib.suppress(FileNotFoundError):
            if stat.S_ISLNK(os.stat(name, dir_fd=folder, follow_symlinks=False).st_mode):
                raise Error(str(self), f"'{name}' is a link", "a campaign's folder without links",
                            "copy the files into the folder")

    def _stat(self):
        """Its status; None when there is none."""
        try:
            with self.parent.opened() as folder:
                found = os.stat(self.name, dir_fd=folder, follow_symlinks=False)
                if stat.S_ISLNK(found.st_mode):
                    self._reject_link(folder, self.name)
                return found
        except (FileNotFoundError, NotADirectoryError):
            return None
        except OSError as error:
            raise self._unreadable(error) from None

    def _unreadable(self, error):
        return Error(str(self), f"it cannot be read: {error.strerror}", "", "")

    def exists(self):
        return self._stat() is not None

    def is_file(self):
        found = self._stat()
        return found is not None and stat.S_ISREG(found.st_mode)

    def size(self):
        """Of a regular file, in bytes; None when there is none."""
        found = self._stat()
        return found.st_size if found is not None and stat.S_ISREG(found.st_mode) else None

    def children(self, suffix=""):
        """The places of all that this folder has, by name; none when there is no such folder."""
        try:
            with self.opened() as folder:
                names = sorted(os.listdir(folder))
            return [Inside(self.root, *self.parts, name) for name in names if name.endswith(suffix)]
        except (FileNotFoundError, NotADirectoryError):
            return []
        except OSError as error:
            raise self._unreadable(error) from None

    # writing

    def make_folder(self):
        """Makes this folder, which other processes may remove while it is empty."""
        for tries_left in reversed(range(MAX_TRIES)):
            try:
                with self.opened(makes=True):
                    return
            except FileNotFoundError:
                if not tries_left:
                    raise

    def take(self, path):
        """Renames a finished file to this place. A link in the place is replaced."""
        with self.parent.opened(makes=True) as folder:
            os.replace(path, self.name, dst_dir_fd=folder)

    def append(self, text):
        """Appends to a text file, which is made where it is missing."""
        self.parent.make_folder()
        descriptor = self.open(os.O_WRONLY | os.O_APPEND | os.O_CREAT)
        with open(descriptor, "a", encoding="utf-8") as file:
            file.write(text)

    def write(self, text):
        """Writes a text file atomically. A link in the place is replaced."""
        part = self.parent / f".{self.name}.{os.getpid()}"
        self.parent.make_folder()
        part.unlink()
        try:
            with open(part.open(os.O_WRONLY | os.O_CREAT | os.O_EXCL), "w", encoding="utf-8") as file:
                file.write(text)
            self.take(part.path)
        finally:
            part.unlink()

    def unlink(self):
        """Removes a file or a link, if there is one."""
        with contextlib.suppress(FileNotFoundError), self.parent.opened() as folder:
            os.unlink(self.name, dir_fd=folder)

    def remove_empty(self):
        """Removes this folder unless it has files, to which other processes may be writing."""
        with contextlib.suppress(OSError), self.parent.opened() as folder:
            os.rmdir(self.name, dir_fd=folder)

    def remove_tree(self):
        """Removes this folder and all in it. Links in it are removed, not followed."""
        try:
            with contextlib.suppress(FileNotFoundError, NotADirectoryError), self.parent.opened() as folder:
                shutil.rmtree(self.name, ignore_errors=True, dir_fd=folder)
        except RecursionError:
            raise Error(str(self), "folders nested too deeply", "", f"remove {self.parent}") from None
