# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Figures and previews of frames."""

from __future__ import annotations

import base64
import os
import struct
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._cloud import Cloud
from ._errors import Error, shown
from ._inputs import MAX_UINT32, floats, one_of, path_of, whole, whole_numbers

IMAGE, GRID, _ANGLES, TOP = range(4)  # values of _core.BeamPicture.kind
NO_BEAM = 0xFFFFFFFF


def pyplot() -> Any:
    """Matplotlib, an optional dependency."""
    try:
        import matplotlib.pyplot
    except ImportError as missing:
        raise Error("matplotlib", "it is not installed", "", "pip install 'glidar[plot]'") from missing
    return matplotlib.pyplot


def scale_of(values: npt.NDArray[Any], from_zero: bool = False) -> _core.ColourScale:
    """The colour scale of all pictures of GLIDAR: percentiles, so that outliers do not determine it."""
    return _core.colour_scale(np.ascontiguousarray(values, dtype=np.float64).ravel(), from_zero)


def _limits(scale: _core.ColourScale) -> dict[str, Any]:
    """Limits of the scale as keyword arguments of Matplotlib."""
    return {"vmin": scale.low, "vmax": scale.high} if scale.has_values else {}


def _extend(scale: _core.ColourScale) -> str:
    """Matplotlib's ``extend`` of a colour bar: which of its ends are arrows, because values are beyond the scale."""
    return {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[scale.clips_low, scale.clips_high]


def _arranged(values: npt.NDArray[Any], layout: _core.BeamPicture) -> npt.NDArray[np.float64]:
    """Values of beams arranged in the rows and columns of the picture; NaN for pixels without a beam."""
    beams = layout.beams
    is_shown = beams != NO_BEAM
    return np.where(is_shown, values.ravel()[np.where(is_shown, beams, 0)], np.nan)


def _draw_image(axis: Any, image: npt.NDArray[Any], layout: _core.BeamPicture, options: dict[str, Any]) -> Any:
    """Draws one image on its axes: pixels of a camera, angles, or metres from above."""
    if layout.kind == IMAGE:
        drawn = axis.imshow(image, interpolation="nearest", **options)
        axis.set(xlabel="column", ylabel="row")
        return drawn
    options["aspect"] = "auto" if layout.kind == GRID else "equal"
    bottom, top = (len(image) - 0.5, -0.5) if layout.kind == GRID else (layout.bottom, layout.top)
    drawn = axis.imshow(image, interpolation="nearest", extent=(layout.left, layout.right, bottom, top), **options)
    if layout.kind == TOP:
        axis.set(xlabel="x, m", ylabel="y, m")
        axis.plot(0.0, 0.0, marker=">", color="black")
        return drawn
    axis.set(xlabel="azimuth, \N{DEGREE SIGN}", ylabel="elevation, \N{DEGREE SIGN}")
    if layout.kind == GRID:  # every row has its own elevation
        rows = np.unique(np.linspace(0, len(image) - 1, 5).astype(int))
        axis.set_yticks(rows, [f"{layout.row_elevations_deg[row]:.3g}" for row in rows])
    return drawn


def show_images(images: dict[str, npt.NDArray[Any]], layouts: list[_core.BeamPicture]) -> Any:
    """A figure with an image and its colour bar for each name and return."""
    rows, cols = layouts[0].beams.shape
    is_wide = cols > 2 * rows
    count = len(images) * len(layouts)
    shape = (count, 1) if is_wide else (len(layouts), len(images))
    size = (9.0, max(4.0, 2.0 * count) if is_wide else 4.0 * len(layouts))
    figure, axes = pyplot().subplots(*shape, figsize=size, layout="constrained", squeeze=False)
    shown = [(name, number) for number in range(len(layouts)) for name in images]
    for axis, (name, number) in zip(axes.flat, shown, strict=True):
        is_intensity = name.startswith("intensity")
        scale = scale_of(images[name], is_intensity)
        options = {"cmap": "gray" if is_intensity else "viridis_r", **_limits(scale)}
        drawn = _draw_image(axis, _arranged(images[name], layouts[number]), layouts[number], options)
        axis.set_title(name if len(layouts) == 1 else f"{name}, return {number + 1}")
        if scale.has_values:
            figure.colorbar(drawn, ax=axis, extend=_extend(scale))
    return figure


def plot_points(xyz: npt.NDArray[Any], values: npt.NDArray[Any], label: str, title: str) -> Any:
    """A 3D scatter plot with equal scales along all axes."""
    figure = pyplot().figure(figsize=(7.0, 6.0), layout="constrained")
    axis = figure.add_subplot(projection="3d")
    scale = scale_of(values, label == "intensity")
    drawn = axis.scatter(xyz[:, 0], xyz[:, 1], xyz[:, 2], c=values, s=2.0, cmap="viridis", **_limits(scale))
    axis.set(xlabel="x, m", ylabel="y, m", zlabel="z, m", title=title)
    if len(xyz):
        axis.set_aspect("equal")
        figure.colorbar(drawn, ax=axis, label=label, shrink=0.7, extend=_extend(scale))
    return figure


def plot_cloud(cloud: Cloud, colour: str, max_points: int) -> Any:
    """A 3D scatter plot of an even selection of a cloud's points, coloured by one of its columns."""
    if cloud[colour].ndim != 1:
        raise Error("colour", shown(colour), "a column with one number per point, such as range")
    if whole(max_points, "max_points", MAX_UINT32) == 0:
        raise Error("max_points", "0", "a whole number from 1")
    step = max(1, -(-cloud.points // max_points))
    return plot_points(cloud["xyz"][::step], cloud[colour][::step], colour, cloud.frame_id)


class Picture:
    """A PNG picture, which Jupyter displays."""

    __slots__ = ("data",)

    def __init__(self, data: bytes) -> None:
        self.data = data  # the bytes of the PNG file

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the PNG file atomically.

        Raises:
            Error: the folder does not exist, the disk is full ...; an existing file stays unchanged.
        """
        _core.write_file(path_of(path, "path"), self.data)

    def _repr_png_(self) -> bytes:
        return self.data

    def __repr__(self) -> str:
        width, height = struct.unpack(">II", self.data[16:24])
        return f"<glidar.Picture of {width} x {height} pixels>"


def set_picture(
    options: _core.OutputOptions,
    colour_by: str,
    size: tuple[int, int],
    eye: npt.ArrayLike | None,
    target: npt.ArrayLike | None,
) -> None:
    """Sets the options of pictures of clouds."""
    one_of(colour_by, "colour_by", _core.colour_by_names())
    width, height = (int(side) for side in whole_numbers(size, "picture_size", 2, 32))
    options.set_picture(colour_by, width, height)
    if eye is not None:
        options.set_view_eye(floats(eye, "view_eye", (3,)))
    if target is not None:
        options.set_view_target(floats(target, "view_target", (3,)))


def picture_of(write: Callable[[Path], None], name: str) -> Picture:
    """The PNG file that `write` writes under a name."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        write(path)
        return Picture(path.read_bytes())


def html_table(rows: dict[str, object]) -> str:
    """Names and values as a small HTML table."""
    cells = "".join(f"<tr><th style='text-align:left'>{name}</th><td>{value}</td></tr>" for name, value in rows.items())
    return f"<table>{cells}</table>"


def html_picture(write: Callable[[Path], None]) -> str:
    """The PNG file that `write` writes, as an HTML image."""
    text = base64.b64encode(picture_of(write, "preview.png").data).decode()
    return f"<img src='data:image/png;base64,{text}' style='max-width:100%'>"
