# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Textures of the satellite. All but those of a solar panel repeat without a seam."""

import numpy as np

from .images import encode_normals, encode_png, normals_of_heights
from .noise import fractal_noise, gradient_noise, uniforms

FOIL = 256  # pixels per side
CELL, CELLS_U, CELLS_V = 36, 8, 6  # pixels per solar cell, cells per panel


def pixels(width, height):
    """x to the right and y upwards of each pixel's centre, in pixels; row 0 on top."""
    return np.meshgrid(np.arange(width) + 0.5, height - np.arange(height) - 0.5)


def folds(x, y, size, period, seed):
    """Creases: valleys of zero where noise changes sign, flat facets between."""
    at = np.stack([x * period / size, y * period / size, np.full_like(x, 0.37)], axis=-1)
    shift = 0.35 * np.stack([gradient_noise(at, seed + n, period) for n in range(3)], axis=-1)
    shift[..., 2] = 0.0
    return np.abs(gradient_noise(at + shift, seed + 9, period))


def foil():
    """Gold foil: colour and crinkle normals."""
    x, y = pixels(FOIL, FOIL)
    height = sum(weight * folds(x, y, FOIL, period, 60 + period)
                 for period, weight in ((3, 1.0), (6, 0.8), (13, 0.45), (24, 0.15)))
    at = np.stack([x * 3 / FOIL, y * 3 / FOIL, np.full_like(x, 0.5)], axis=-1)
    shade = 0.86 + 0.10 * fractal_noise(at, 71, 4, 0.6, 3) + 0.10 * np.minimum(height, 0.6)
    seam = (np.minimum(x, FOIL - x) < 2.0) | (np.minimum(y, FOIL - y) < 2.0)
    shade = np.where(seam, 0.72, shade)
    colour = shade[..., None] * np.array([1.0, 0.98, 0.94])
    return colour, normals_of_heights(height, 8.5)


def solar_cells():
    """A panel of cells with cropped corners, two bus bars and fingers: colour, gloss, normals."""
    x, y = pixels(CELL * CELLS_U, CELL * CELLS_V)
    column, row = np.floor(x / CELL).astype(int), np.floor(y / CELL).astype(int)
    dx, dy = np.abs(x % CELL - CELL / 2.0), np.abs(y % CELL - CELL / 2.0)
    cell = (dx < CELL / 2.0 - 1.0) & (dy < CELL / 2.0 - 1.0) & (dx + dy < 0.86 * CELL)
    bar = cell & (np.abs(dx - 0.22 * CELL) < 1.0)
    finger = cell & (y % 4.0 < 1.0)
    tone = 0.85 + 0.3 * uniforms(81, CELLS_V, CELLS_U)[row, column]
    colour = np.where(cell[..., None], tone[..., None] * np.array([0.05, 0.09, 0.27]),
                      np.array([0.52, 0.50, 0.46]))
    colour = np.where(finger[..., None], colour + 0.06, colour)
    colour = np.where(bar[..., None], np.array([0.62, 0.63, 0.66]), colour)
    gloss = np.where(cell, 0.9, 0.12)
    gloss = np.where(bar, 1.0, gloss)
    height = np.where(cell, 0.8, 0.0) + np.where(bar, 0.2, 0.0)
    return colour, gloss, normals_of_heights(height, 1.4)


def weave_height():
    """Twill of carbon fibre, 4 x 4 threads."""
    x, y = pixels(64, 64)
    warp = (np.floor(x / 16) + np.floor(y / 16)).astype(int) % 4 < 2
    across = np.where(warp, x, y) % 16 / 16.0
    along = np.where(warp, y, x) % 32 / 32.0
    return 0.25 + 0.5 * np.sin(np.pi * across) ** 0.7 + 0.25 * np.sin(np.pi * along)


def wire_mesh():
    """Opacity of a square wire mesh, 4 x 4 openings."""
    x, y = pixels(64, 64)
    wire = (np.minimum(x % 16, 16 - x % 16) < 1.6) | (np.minimum(y % 16, 16 - y % 16) < 1.6)
    return np.where(wire, 1.0, 0.0)


def radiator_tiles():
    """Mirror tiles of a radiator, colour: bright squares with darker joints."""
    x, y = pixels(64, 64)
    joint = (np.minimum(x % 32, 32 - x % 32) < 1.0) | (np.minimum(y % 32, 32 - y % 32) < 1.0)
    tone = 0.92 + 0.08 * uniforms(91, 2, 2)[(y // 32).astype(int), (x // 32).astype(int)]
    return np.where(joint, 0.55, tone)


def write_textures(folder):
    """Writes every texture that the materials name."""
    foil_colour, foil_normals = foil()
    cell_colour, cell_gloss, cell_normals = solar_cells()
    images = {
        "foil.png": foil_colour,
        "foil_normals.png": encode_normals(foil_normals),
        "cells.png": cell_colour,
        "cells_gloss.png": cell_gloss,
        "cells_normals.png": encode_normals(cell_normals),
        "weave_height.png": weave_height(),
        "wire_mesh.png": wire_mesh(),
        "radiator.png": radiator_tiles(),
    }
    for name, image in images.items():
        (folder / name).write_bytes(encode_png(image))
