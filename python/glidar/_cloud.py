# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Clouds: columns of a frame."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import Error
from ._inputs import FloatArray, shape_text

Array = npt.NDArray[Any]


class Cloud(Mapping[str, Array]):
    """Columns of a frame in a coordinate frame, by name. An organised cloud's arrays are (rows, cols)
    or (rows, cols, k), one of hits alone (n,) or (n, k). They are the caller's own, may be written
    to, and export __dlpack__."""

    def __init__(self, core: _core.Cloud, flat: bool) -> None:
        self._core = core
        self._places = {name: index for index, name in enumerate(core.columns)}
        self._flat = flat

    def __getitem__(self, name: str) -> Array:
        if name not in self._places:
            raise Error("cloud", f"no column {name!r}", ", ".join(self._places), "ask for it: cloud(columns=[...])")
        column = self._core.column(self._places[name])
        return column[0] if self._flat else column

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)

    def __contains__(self, name: object) -> bool:
        return name in self._places

    @property
    def points(self) -> int:
        """Points, with those that are misses."""
        return self._core.rows * self._core.cols

    @property
    def frame_id(self) -> str:
        """Name of the coordinate frame."""
        return self._core.frame_id

    @property
    def world_from_cloud(self) -> FloatArray:
        """Pose of that frame in the world, 4x4."""
        return self._core.world_from_cloud

    def to_open3d(self) -> Any:
        """The hits as open3d.geometry.PointCloud, with normals if the cloud has them."""
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
