# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of frames, for people."""

from __future__ import annotations

import base64
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import Error


def pyplot() -> Any:
    """Matplotlib, which GLIDAR does without otherwise."""
    try:
        import matplotlib.pyplot
    except ImportError as missing:
        raise Error("matplotlib", "it is not installed", "", "pip install 'glidar[plot]'") from missing
    return matplotlib.pyplot


def show_images(images: dict[str, npt.NDArray[Any]]) -> Any:
    """A figure with an image for each name, with its scale."""
    rows, cols = next(iter(images.values())).shape
    is_wide = cols > 2 * rows
    shape = (len(images), 1) if is_wide else (1, len(images))
    figure, axes = pyplot().subplots(*shape, figsize=(9.0, 4.0), layout="constrained", squeeze=False)
    for axis, (name, image) in zip(axes.flat, images.items(), strict=True):
        colours = "gray" if name.startswith("intensity") else "viridis_r"
        drawn = axis.imshow(image, cmap=colours, interpolation="nearest", aspect="auto" if is_wide else "equal")
        axis.set(title=name, xlabel="column", ylabel="row")
        if np.isfinite(image).any():
            figure.colorbar(drawn, ax=axis)
    return figure


def plot_points(xyz: npt.NDArray[Any], values: npt.NDArray[Any], label: str, title: str) -> Any:
    """A figure of points in space, coloured, with equal scales along all axes."""
    figure = pyplot().figure(figsize=(7.0, 6.0), layout="constrained")
    axis = figure.add_subplot(projection="3d")
    drawn = axis.scatter(xyz[:, 0], xyz[:, 1], xyz[:, 2], c=values, s=2.0, cmap="viridis")
    axis.set(xlabel="x, m", ylabel="y, m", zlabel="z, m", title=title)
    if len(xyz):
        axis.set_aspect("equal")
        figure.colorbar(drawn, ax=axis, label=label, shrink=0.7)
    return figure


def html_table(rows: dict[str, object]) -> str:
    """Names and values as a small table."""
    cells = "".join(f"<tr><th style='text-align:left'>{name}</th><td>{value}</td></tr>" for name, value in rows.items())
    return f"<table>{cells}</table>"


def html_picture(write: Callable[[Path], None]) -> str:
    """The PNG file that `write` makes, as a part of a page."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "preview.png"
        write(path)
        text = base64.b64encode(path.read_bytes()).decode()
    return f"<img src='data:image/png;base64,{text}' style='max-width:100%'>"
