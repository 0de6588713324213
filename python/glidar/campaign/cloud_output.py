# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""One file per trial: PCD and PLY clouds, EXR images, bags, and KITTI folders of scans, labels and calibrations."""

KITTI_FOLDER = "kitti"


class CloudOutput:
    """Clouds, images and bags like those of `glidar render`, without sidecars, because the index has their contents."""

    def __init__(self, folder, suffix, options, temp):
        self._folder, self._suffix, self._temp = folder, suffix, temp
        self._every = options.every
        self._columns = options.columns
        self._files = []

    def add(self, row, trial, frame):
        if trial % self._every:
            return
        name = f"{trial:09}{self._suffix}"
        path = self._temp.path(name)
        frame.save(path, self._columns)
        self._files.append((f"{self._folder}/{name}", path))

    def finish(self):
        return self._files


class KittiOutput:
    """A KITTI folder like `glidar render -o OUT.kitti` writes, with a file of each type for each trial."""

    def __init__(self, temp):
        self._temp = temp
        self._files = []

    def add(self, row, trial, frame):
        folder = self._temp.path(f"{trial:09}.kitti")
        frame.save(folder, None)
        for path in sorted(folder.glob("*/*")):
            name = f"{KITTI_FOLDER}/{path.parent.name}/{trial:09}{path.suffix}"
            self._files.append((name, path))

    def finish(self):
        return self._files
