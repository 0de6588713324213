# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Triangle meshes as arrays, with conversions from and to other libraries, none of which is required."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import Error
from ._state import has_same_fields


@dataclass(frozen=True, eq=False)  # == of arrays is elementwise
class Mesh:
    """A triangle mesh: arrays with one row per vertex or triangle, right-handed. Meshes are equal when their
    arrays have the same types, shapes and bits. They are not hashable, because arrays are mutable."""

    vertices: npt.ArrayLike
    """(V, 3), m, in the object's coordinate frame."""
    triangles: npt.ArrayLike
    """(T, 3), vertex indices, counter-clockwise when seen from the front."""
    normals: npt.ArrayLike | None = None
    """(V, 3), unit vectors, or zeros for vertices without a normal; None: flat shading."""
    uvs: npt.ArrayLike | None = None
    """(V, 2), texture coordinates, v upwards."""
    colours: npt.ArrayLike | None = None
    """(V, 3), RGB from 0 to 1."""

    def __eq__(self, other: object) -> bool:
        return has_same_fields(self, other)

    __hash__ = None  # type: ignore[assignment]

    def to_trimesh(self) -> Any:
        """The mesh as a trimesh.Trimesh, with vertices and triangles in the same order."""
        import trimesh

        return trimesh.Trimesh(
            self.vertices, self.triangles, vertex_normals=self.normals, vertex_colors=self.colours, process=False
        )

    def to_open3d(self) -> Any:
        """The mesh as an open3d.geometry.TriangleMesh."""
        import open3d

        utility = open3d.utility
        mesh = open3d.geometry.TriangleMesh(
            utility.Vector3dVector(np.asarray(self.vertices, np.float64)),
            utility.Vector3iVector(np.asarray(self.triangles, np.int32)),
        )
        if self.normals is not None:
            mesh.vertex_normals = utility.Vector3dVector(np.asarray(self.normals, np.float64))
        if self.colours is not None:
            mesh.vertex_colors = utility.Vector3dVector(np.asarray(self.colours, np.float64))
        return mesh


def _require_parts(mesh: object, *names: str) -> None:
    for name in names:
        if not hasattr(mesh, name):
            raise Error("mesh", f"a {type(mesh).__name__} without {name}", f"a mesh with {', '.join(names)}")


def from_trimesh(mesh: Any) -> Mesh:
    """Converts vertices, faces and vertex colours of a trimesh.Trimesh.

    Raises:
        Error: the object has no vertices or faces.
    """
    _require_parts(mesh, "vertices", "faces")
    visual = getattr(mesh, "visual", None)
    colours = None
    if getattr(visual, "kind", None) == "vertex":
        colours = np.asarray(visual.vertex_colors)[:, :3] / 255.0  # type: ignore[union-attr]
    return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces), colours=colours)


def from_open3d(mesh: Any) -> Mesh:
    """Converts an open3d.geometry.TriangleMesh with its vertex normals and colours.

    Raises:
        Error: the object has no vertices or triangles.
    """
    _require_parts(mesh, "vertices", "triangles", "vertex_normals", "vertex_colors")
    normals, colours = np.asarray(mesh.vertex_normals), np.asarray(mesh.vertex_colors)
    return Mesh(
        np.asarray(mesh.vertices),
        np.asarray(mesh.triangles),
        normals=normals if len(normals) else None,
        colours=colours if len(colours) else None,
    )


def mesh_of(mesh: object) -> Mesh:
    """Converts a mesh of trimesh or Open3D; returns a Mesh as it is."""
    if isinstance(mesh, Mesh):
        return mesh
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return from_trimesh(mesh)
    if hasattr(mesh, "vertices") and hasattr(mesh, "triangles"):
        return from_open3d(mesh)
    if hasattr(mesh, "vertex") and hasattr(mesh, "to_legacy"):  # a mesh of Open3D's tensor API
        return from_open3d(mesh.to_legacy())
    found = f"a {type(mesh).__name__}"
    raise Error("mesh", found, "vertices and triangles, or a mesh of glidar, trimesh or Open3D")
