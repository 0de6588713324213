# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Images as float arrays (rows, columns[, channels]), row 0 on top, 0..1."""

import io

import numpy as np
from PIL import Image


def to_bytes(image):
    """Rounds 0..1 to 0..255."""
    return np.floor(np.clip(image, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def encode_png(image):
    """PNG file bytes, grey or rgb. The pixels are the promise; the compression is Pillow's."""
    stream = io.BytesIO()
    Image.fromarray(to_bytes(image)).save(stream, format="PNG", optimize=True)
    return stream.getvalue()


def encode_normals(normals):
    """Tangent-space normals as colours: n = 2 rgb - 1, red along +u, green along +v (up)."""
    return 0.5 + 0.5 * normals


def normals_of_heights(height, strength):
    """Normals of a height image that repeats; strength is the height of white in pixels."""
    slope_u = 0.5 * strength * (np.roll(height, -1, axis=1) - np.roll(height, 1, axis=1))
    slope_v = 0.5 * strength * (np.roll(height, 1, axis=0) - np.roll(height, -1, axis=0))
    normals = np.stack([-slope_u, -slope_v, np.ones_like(height)], axis=-1)
    return normals / np.linalg.norm(normals, axis=-1, keepdims=True)
