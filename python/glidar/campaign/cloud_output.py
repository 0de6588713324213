# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""One file a trial: PCD and PLY clouds, and KITTI's folder of scans, labels and calibrations."""

KITTI_FOLDER = "kitti"


class CloudOutput:
    """Clouds as `glidar render` writes them, without sidecars: the index tells what they say."""

    def __init__(self, folder, suffix, options, scratch):
        self._folder, self._suffix, self._scratch = folder, suffix, scratch
        self._every = options.every
        self._columns = options.columns
        self._files = []

    def add(self, row, trial, frame):
        if trial % self._every:
            return
        name = f"{trial:09}{self._suffix}"
        path = self._scratch.path(name)
        frame.save(path, self._columns)
        self._files.append((f"{self._folder}/{name}", path))

    def finish(self):
        return self._files


class KittiOutput:
    """KITTI's folder as `glidar render -o OUT.kitti` writes it, a file of each kind for each trial."""

    def __init__(self, scratch):
        self._scratch = scratch
        self._files = []

    def add(self, row, trial, frame):
        folder = self._scratch.path(f"{trial:09}.kitti")
        frame.save(folder, None)
        for path in sorted(folder.glob("*/*")):
            name = f"{KITTI_FOLDER}/{path.parent.name}/{trial:09}{path.suffix}"
            self._files.append((name, path))

    def finish(self):
        return self._files
