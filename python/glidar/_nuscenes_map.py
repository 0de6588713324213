# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The map of a nuScenes scene: an image of driveable surfaces and sidewalks from above."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import Error
from ._inputs import FloatArray
from ._object import SceneObject

if TYPE_CHECKING:
    from PIL import Image

RESOLUTION_M = 0.1  # per pixel; the devkit's
MARGIN_M = 100.0  # around the trajectory; the devkit shows up to 57 m
MAX_SIDE = 30000  # pixels
FOREGROUND = 255


class GroundMap:
    """Places the world such that the trajectory has positive coordinates, and draws the ground around it."""

    def __init__(self, positions_m: FloatArray) -> None:
        minimum, maximum = positions_m[:, :2].min(axis=0), positions_m[:, :2].max(axis=0)
        self.offset_m = np.append(np.ceil(MARGIN_M - minimum), 0.0)
        self.width, self.height = (int(np.ceil(side / RESOLUTION_M)) for side in maximum - minimum + 2.0 * MARGIN_M)
        if max(self.width, self.height) > MAX_SIDE:
            raise Error("trajectory", f"it extends over {max(self.width, self.height) * RESOLUTION_M:.0f} m with margins",
                        f"up to {MAX_SIDE * RESOLUTION_M:.0f} m, because the map has one image",
                        "divide it into several scenes")  # fmt: skip

    def image(self, ground: list[SceneObject]) -> Image.Image:
        """The objects of the ground, white on black, y up."""
        from PIL import Image, ImageDraw

        picture: Any = Image.new("L", (self.width, self.height))
        draw = ImageDraw.Draw(picture)
        for one in ground:
            for corners in self._pixels(one):
                draw.polygon([tuple(corner) for corner in corners], fill=FOREGROUND)
        return picture

    def _pixels(self, one: SceneObject) -> FloatArray:
        """The triangles that face up and are in the image, (n, 3, 2)."""
        mesh = one.mesh
        vertices = np.asarray(mesh.vertices, float) * np.asarray(one.scale) @ one.pose[:3, :3].T + one.pose[:3, 3]
        corners = (vertices + self.offset_m)[np.asarray(mesh.triangles)]
        up = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] > 0.0
        pixels: FloatArray = corners[up, :, :2] / RESOLUTION_M
        pixels[..., 1] = self.height - pixels[..., 1]
        inside = (pixels.max(axis=1) >= 0).all(axis=1) & (pixels.min(axis=1) <= (self.width, self.height)).all(axis=1)
        return pixels[inside]
