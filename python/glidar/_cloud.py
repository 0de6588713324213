# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Point clouds: columns of a frame."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error
from ._file_options import file_options, set_cloud
from ._inputs import MAX_UINT32, FloatArray, floats, log, path_of, shape_text, text_of, whole
from ._state import key_of, part, restoring, make_state

Array = npt.NDArray[Any]


@dataclass(frozen=True)
class _StoredCloud:
    """An unpickled cloud with the interface of the extension's clouds."""

    rows: int
    cols: int
    frame_id: str
    world_from_cloud: FloatArray
    columns: list[str]
    arrays: list[Array]

    def column(self, index: int) -> Array:
        """The values of a column, (rows, cols) or (rows, cols, k)."""
        return self.arrays[index]


class Cloud(Mapping[str, Array]):
    """Columns of a frame in a coordinate frame, by name.

    Arrays of an organised cloud are (rows, cols) or (rows, cols, k); those of a cloud of hits only are (n,) or
    (n, k). The caller owns them and may write to them; they export __dlpack__. Lengths are metres, angles
    radians.

    Clouds are equal when their columns, coordinate frame and pose are bit-identical. They are mutable and thus
    not hashable. copy.copy shares the arrays, copy.deepcopy copies them.
    """

    def __init__(self, core: _core.Cloud | _StoredCloud, flat: bool) -> None:
        self._core = core
        self._indices = {name: index for index, name in enumerate(core.columns)}
        self._flat = flat

    def __getitem__(self, name: str) -> Array:
        if name not in self._indices:
            raise Error("cloud", f"no column {name!r}", ", ".join(self._indices), "request it: cloud(columns=[...])")
        column = self._core.column(self._indices[name])
        return column[0] if self._flat else column

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Cloud):
            return NotImplemented
        return self._key() == other._key()

    __hash__ = None  # type: ignore[assignment]

    def _key(self) -> object:
        return key_of([dict(self), self.frame_id, self.world_from_cloud])

    def __getstate__(self) -> dict[str, Any]:
        core = self._core
        return make_state(
            "Cloud",
            shape=(core.rows, core.cols),
            flat=self._flat,
            frame_id=core.frame_id,
            world_from_cloud=core.world_from_cloud,
            columns={name: core.column(index) for name, index in self._indices.items()},
        )

    def __setstate__(self, state: dict[str, Any]) -> None:
        with restoring("Cloud", state):
            rows, cols = (whole(size, "shape", MAX_UINT32) for size in part(state, "shape", tuple))
            columns = {text_of(name, "columns"): array for name, array in part(state, "columns", dict).items()}
            for name, array in columns.items():
                if not isinstance(array, np.ndarray) or array.shape[:2] != (rows, cols):
                    raise ValueError(f"column {name!r} is not an array {rows} x {cols}")
            # out-of-band buffers of a pickle may be read-only
            columns = {name: a if a.flags.writeable else a.copy() for name, a in columns.items()}
            pose = floats(state["world_from_cloud"], "world_from_cloud", (4, 4))
            stored = _StoredCloud(rows, cols, part(state, "frame_id", str), pose, list(columns), list(columns.values()))
            Cloud.__init__(self, stored, part(state, "flat", bool))

    def __iter__(self) -> Iterator[str]:
        return iter(self._indices)

    def __len__(self) -> int:
        return len(self._indices)

    def __contains__(self, name: object) -> bool:
        return name in self._indices

    @property
    def points(self) -> int:
        """Number of points, including misses."""
        return self._core.rows * self._core.cols

    @property
    def frame_id(self) -> str:
        """Name of the cloud's coordinate frame."""
        return self._core.frame_id

    @property
    def world_from_cloud(self) -> FloatArray:
        """Pose of the cloud's coordinate frame in the world, (4, 4), m."""
        return self._core.world_from_cloud

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        pcd: str = "binary",
        ply_ascii: bool = False,
    ) -> None:
        """Writes the arrays as they are now, without a sidecar, to a file of a cloud: .pcd, .ply, .npz, .csv or .exr,
        with the columns of the cloud. ``Frame.save`` writes all formats.

        Args:
            pcd, ply_ascii: as for ``Frame.save``.

        Raises:
            Error: another suffix, a missing folder, or a cloud without the columns of the format. An existing file
            stays unchanged.
        """
        options = file_options(pcd, ply_ascii, 1000.0)
        set_cloud(options, None, False, False, "", False)
        columns = {name: np.ascontiguousarray(self._core.column(index)) for name, index in self._indices.items()}
        _core.save_cloud(path_of(path, "path"), columns, self._core, options, log)

    def to_open3d(self) -> Any:
        """The hits as an open3d.geometry.PointCloud, with normals if the cloud has them."""
        import open3d

        xyz = self["xyz"].reshape(-1, 3)
        is_hit = np.isfinite(xyz[:, 0])
        points = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(xyz[is_hit]))
        if "normal" in self:
            normals = self["normal"].reshape(-1, 3)[is_hit].astype(np.float64)
            points.normals = open3d.utility.Vector3dVector(normals)
        return points

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{name}</td><td>{shape_text(values.shape)}</td><td>{values.dtype}</td></tr>"
            for name, values in self.items()
        )
        return f"<p>{self.points} points in {self.frame_id}</p><table>{rows}</table>"

    def __repr__(self) -> str:
        return f"<glidar.Cloud of {self.points} points in {self.frame_id}: {', '.join(self)}>"
