# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""NPZ shards: the columns of many trials as arrays trial x row x column."""

import contextlib
import re
import zipfile

import numpy as np

from glidar import Error
from glidar._errors import excerpt
from glidar.campaign import files

FOLDER = "npz"
MEMBER = re.compile(r"(?:\d{1,10}x\d{1,10}/)?[a-z_]{1,64}\.npy", re.ASCII)
MAX_BYTES = 1 << 34  # of an uncompressed array
REAL = {"f32": np.dtype(np.float32), "f64": np.dtype(np.float64)}


def stored_type(dtype, real):
    """The type that a column is stored with: the campaign file selects it for float64; others are unchanged."""
    return REAL[real] if dtype == np.float64 else dtype


def write_npz(path, arrays, compress):
    """Like numpy.savez, without copies of the arrays; equal arrays give equal bytes."""
    method = zipfile.ZIP_DEFLATED if compress else zipfile.ZIP_STORED
    with zipfile.ZipFile(path, "w", method, compresslevel=1 if compress else None) as archive:
        for name, array in arrays.items():
            array = np.ascontiguousarray(array)
            with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                header = np.lib.format.header_data_from_array_1_0(array)
                np.lib.format.write_array_header_1_0(member, header)
                if array.size:
                    member.write(array.reshape(-1).view(np.uint8))


@contextlib.contextmanager
def opened(path):
    """Opens an NPZ shard and checks the names and sizes of its members."""
    with files.open_input(path) as file, np.load(file, allow_pickle=False) as arrays:
        if not isinstance(arrays, np.lib.npyio.NpzFile):
            raise Error(str(path), "it is not an NPZ file", "a file that glidar campaign wrote", "")
        for member in arrays.zip.infolist():
            if not MEMBER.fullmatch(member.filename) or member.file_size > MAX_BYTES:
                raise Error(f"{path}: {excerpt(member.filename)}", f"a member of {member.file_size} bytes",
                            f"names of columns, and at most {MAX_BYTES} bytes", "")
        yield arrays


class NpzOutput:
    """Collects the trials of a shard. Frames of one shape give arrays `range`, `intensity` ...; when shapes differ
    between trials (several sensors), each shape has arrays of its own: `16x1808/range` ..."""

    def __init__(self, plan, temp, shard):
        self._options = plan.spec.outputs.npz
        self._one_shape = plan.one_shape
        self._temp = temp
        self._name = f"shard-{shard:06}.npz"
        self._count = plan.trials_of(shard)[1]
        self._groups = {}  # shape -> {column: array of all trials}
        self._shapes = [None] * self._count
        self._trials = [0] * self._count

    def add(self, row, trial, frame):
        columns = frame.columns(self._options.columns)
        shape = next(iter(columns.values())).shape[:2]
        group = self._groups.get(shape)
        if group is None:
            group = {name: np.empty((self._count, *values.shape),
                                    stored_type(values.dtype, self._options.real))
                     for name, values in columns.items()}
            self._groups[shape] = group
        for name, values in columns.items():
            group[name][row] = values
        self._shapes[row], self._trials[row] = shape, trial

    def arrays(self):
        """The arrays of the file; failed trials have no row."""
        result = {}
        for shape in sorted(self._groups):
            rows = [row for row, own in enumerate(self._shapes) if own == shape]
            prefix = "" if self._one_shape else f"{shape[0]}x{shape[1]}/"
            result[f"{prefix}trial"] = np.array([self._trials[row] for row in rows], np.int64)
            for name, values in self._groups[shape].items():
                whole = len(rows) == self._count
                result[prefix + name] = values if whole else values[rows]
        return result

    def finish(self):
        """The files to publish: (name with {hash} as a placeholder for the content's hash, path)."""
        path = self._temp.path(self._name)
        write_npz(path, self.arrays(), self._options.compress)
        self._groups = {}
        return [(f"{FOLDER}/{self._name[:-4]}-{{hash}}.npz", path)]
