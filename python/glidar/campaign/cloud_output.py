# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""One file a trial: PCD and PLY clouds, and KITTI's folder of scans."""

KITTI_FOLDER = "kitti/velodyne"


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
