# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Frames: what a sensor reports, and what can be asked of it."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._cloud import Cloud
from ._errors import Error, shown
from ._fisher_information import FisherInformation
from ._inputs import MOST_32, FloatArray, column_list, floats, log, one_of, path_of, whole, whole_numbers
from ._origin import Origin
from ._pictures import IMAGE, Picture, html_picture, html_table, picture_of, plot_points, show_images
from ._state import Immutable, key_of, part, restoring, stated
from ._status import ReturnSource, Status
from ._point_trace import PointTrace, trace_of
from ._ground_truth import GroundTruth

_PCD = ("ascii", "binary", "binary_compressed")


def _set_picture(
    options: _core.SaveOptions,
    colour_by: str,
    size: tuple[int, int],
    eye: npt.ArrayLike | None,
    target: npt.ArrayLike | None,
) -> None:
    """Options of pictures of clouds."""
    one_of(colour_by, "colour_by", _core.colour_by_names())
    width, height = (int(side) for side in whole_numbers(size, "picture_size", 2, 32))
    options.set_picture(colour_by, width, height)
    if eye is not None:
        options.set_view_eye(floats(eye, "view_eye", (3,)))
    if target is not None:
        options.set_view_target(floats(target, "view_target", (3,)))


class Frame(Immutable):
    """One measurement: what the sensor reports per beam, with the truth attached. Arrays are
    (rows, cols), read-only views of the frame's memory, which they keep alive.

    Two frames are equal when their poses, numbers and all kept columns are, to the last bit. Frames can be
    hashed, copied and pickled. A pickled frame takes its columns, its sensor and its scene with it; the
    scene, which names files, is read when ``cloud``, ``save`` or ``explain`` need it.
    """

    __slots__ = ("_core", "_has_renderer", "_has_scene", "_origin")

    def __init__(self, core: _core.Frame, origin: Origin) -> None:
        self._core = core
        self._origin = origin
        self._has_scene = self._has_renderer = True

    def _with_scene(self) -> _core.Frame:
        """The frame with the scene that it was measured of."""
        if not self._has_scene:
            self._origin.attach_scene(self._core)
            self._has_scene = True
        return self._core

    def _with_renderer(self) -> _core.Frame:
        """The frame with scene and renderer, to be measured again."""
        if not self._has_renderer:
            self._origin.attach_renderer(self._core)
            self._has_renderer = True
        return self._core

    def __getstate__(self) -> dict[str, Any]:
        core = self._core
        return stated("Frame", numbers=_core.frame_state(core), arrays=_core.frame_arrays(core), origin=self._origin)

    def __setstate__(self, state: dict[str, Any]) -> None:
        with restoring("Frame", state):
            self._has_scene = self._has_renderer = False
            self._origin = part(state, "origin", Origin)
            sensor = self._origin.sensor._core
            self._core = _core.restore_frame(part(state, "numbers", dict), part(state, "arrays", dict), sensor)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Frame):
            return NotImplemented
        if self._core is other._core:
            return True
        return self._numbers() == other._numbers() and _core.has_same_columns(self._core, other._core)

    def __hash__(self) -> int:
        return hash((self.rows, self.cols, self.seed, self.number, self.sensor_id, self.stamp_ns))

    def _numbers(self) -> object:
        return (self.rows, self.cols, self.frame_id, key_of(_core.frame_state(self._core)))

    @property
    def rows(self) -> int:
        """Rows; with several returns the rows of each, one below the other."""
        return self._core.rows

    @property
    def cols(self) -> int:
        """Columns."""
        return self._core.cols

    @property
    def range_m(self) -> FloatArray:
        """Measured distance along the beam from its origin, m; NaN unless status is hit."""
        return self._measured("range_m")

    @property
    def intensity(self) -> npt.NDArray[np.float32]:
        """Received signal; 0 unless hit."""
        return self._measured("intensity")

    @property
    def status(self) -> npt.NDArray[np.uint8]:
        """Why a beam has a return, or has none: see ``Status``."""
        return self._measured("status")

    @property
    def return_source(self) -> npt.NDArray[np.uint8]:
        """What made a return: see ``ReturnSource``."""
        found = self._core.measured("return_source")
        if found is not None:
            return found
        return np.where(self.status == Status.hit, np.uint8(ReturnSource.surface), np.uint8(ReturnSource.none))

    @property
    def sigma_m(self) -> npt.NDArray[np.float32]:
        """Standard deviation of the random error of range_m."""
        found = self._core.measured("sigma_m")
        return np.broadcast_to(np.float32(0.0), (self.rows, self.cols)) if found is None else found

    def _measured(self, name: str) -> npt.NDArray[Any]:
        found = self._core.measured(name)
        assert found is not None
        return found

    @property
    def hits(self) -> int:
        """Beams with a return."""
        return int(np.count_nonzero(self.status == Status.hit))

    @property
    def ground_truth(self) -> GroundTruth:
        """What is there."""
        return GroundTruth(self)

    @property
    def stamp_ns(self) -> int:
        """When the frame started."""
        return self._core.stamp_ns

    @property
    def seed(self) -> int:
        """Of its random numbers."""
        return self._core.seed

    @property
    def number(self) -> int:
        """Of the frame in its sequence."""
        return self._core.number

    @property
    def sensor_id(self) -> int:
        """Which sensor of a rig."""
        return self._core.sensor_id

    @property
    def frame_id(self) -> str:
        """Name of the sensor's coordinate frame."""
        return self._core.frame_id

    @property
    def world_from_sensor(self) -> FloatArray:
        """The sensor's pose at stamp_ns, 4x4."""
        return self._core.world_from_sensor

    @property
    def world_from_objects(self) -> FloatArray:
        """The objects' poses at stamp_ns, (k, 4, 4), without scale."""
        return np.array(self._core.world_from_objects).reshape(-1, 4, 4)

    def cloud(
        self,
        columns: str | Iterable[str] | None = None,
        *,
        frame: str = "sensor",
        hits_only: bool = False,
        deskew: bool = False,
    ) -> Cloud:
        """The measurement as a cloud.

        Args:
            columns: names (docs/python.md), "all", or None for xyz, intensity, range, normal,
                instance, class.
            frame: axes: "sensor", "optical", "ros", "gl", "legacy" or "world".
            hits_only: leave misses out.
            deskew: points where a moving sensor met them.

        Raises:
            Error: an unknown column or frame, or one that the frame was measured without.
        """
        names = column_list(columns)
        if hits_only and "xyz" not in names:
            names.append("xyz")
        return Cloud(self._with_scene().cloud(names, frame, deskew, hits_only), hits_only)

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        columns: str | Iterable[str] | None = None,
        layout: str | None = None,
        frame: str = "sensor",
        hits_only: bool = False,
        deskew: bool = False,
        pcd: str = "binary",
        ply_ascii: bool = False,
        depth_units_per_m: float = 1000.0,
        sidecar: bool = True,
        colour_by: str = "height",
        picture_size: tuple[int, int] = (1400, 1000),
        view_eye: npt.ArrayLike | None = None,
        view_target: npt.ArrayLike | None = None,
    ) -> None:
        """Writes a file as ``glidar render -o PATH`` does; the suffix says what: .pcd .ply .npz .csv
        .bin .kitti .npy .depth.png .depth.tiff .rgb.png .normal.png .instance.png .class.png .png .bev.png
        .view.png .transform.

        Args:
            columns, frame, hits_only, deskew: as for ``cloud``.
            layout: fields of another sensor's driver in the place of columns, such as "velodyne".
            pcd: "ascii", "binary" or "binary_compressed".
            ply_ascii: PLY as text.
            depth_units_per_m: of 16-bit depth images.
            sidecar: write PATH.json beside a cloud or image.
            colour_by: of .bev.png and .view.png: "height", "range", "intensity", "ring", "class" or
                "instance".
            picture_size: width and height of these, pixels.
            view_eye, view_target: where .view.png is seen from, and what it looks at, (3,), m, in the
                axes of the cloud; None: so that most points are seen.

        Raises:
            Error: an unknown suffix or layout, no such folder, a column that was not kept, a file that
            scene or sensor were read from; what stood under the name stays.
        """
        scale = float(floats(depth_units_per_m, "depth_units_per_m", ()))
        if scale <= 0.0:
            raise Error("depth_units_per_m", f"{scale}", "a finite number above 0")
        encoding = _PCD.index(one_of(pcd, "pcd", _PCD))
        if layout is not None and columns is not None:
            remedy = "a layout has its own columns: leave columns out"
            raise Error("layout and columns", "both are given", "one of the two", remedy)
        options = _core.SaveOptions()
        options.columns = column_list(columns)
        options.frame = frame
        options.deskew = deskew
        options.set_pcd(encoding)
        options.set_ply_ascii(ply_ascii)
        options.set_dense(hits_only)
        options.set_sidecar(sidecar)
        options.set_layout(layout or "")
        options.set_depth_units_per_m(scale)
        _set_picture(options, colour_by, picture_size, view_eye, view_target)
        self._with_scene().save(path_of(path, "path"), options, log)

    def bird_eye(
        self, *, colour_by: str = "height", size: tuple[int, int] = (1400, 1000), frame: str = "sensor"
    ) -> Picture:
        """The hits from above, x to the right and y up, with axes in metres: as ``save`` writes .bev.png.

        Args:
            colour_by, size: as colour_by and picture_size of ``save``.
            frame: axes, as for ``cloud``.

        Raises:
            Error: rings of a camera, or an unknown name.
        """
        return picture_of(
            lambda path: self.save(path, colour_by=colour_by, picture_size=size, frame=frame), "picture.bev.png"
        )

    def perspective(
        self,
        *,
        colour_by: str = "height",
        size: tuple[int, int] = (1400, 1000),
        frame: str = "sensor",
        eye: npt.ArrayLike | None = None,
        target: npt.ArrayLike | None = None,
    ) -> Picture:
        """The hits in perspective, with a grid on the ground: as ``save`` writes .view.png.

        Args:
            colour_by, size, eye, target: as colour_by, picture_size, view_eye and view_target of
                ``save``.
            frame: axes, as for ``cloud``.

        Raises:
            Error: rings of a camera, an unknown name, or an eye at the target.
        """

        def write(path: Path) -> None:
            self.save(
                path, colour_by=colour_by, picture_size=size, frame=frame, view_eye=eye, view_target=target
            )

        return picture_of(write, "picture.view.png")

    def show(self) -> Any:
        """A matplotlib figure: depth (of LiDARs: range) and intensity, as images; of LiDARs upright, by
        azimuth and elevation, or from above. Jupyter draws it; elsewhere ``matplotlib.pyplot.show()``
        opens it."""
        layouts = [self._core.picture(number) for number in range(self._core.returns)]
        is_camera = layouts[0].kind == IMAGE
        name, distance = ("depth, m", self.cloud(["depth"])["depth"]) if is_camera else (
            "range, m", self.range_m + self._core.range_offset_m)
        intensity = np.where(np.isfinite(distance), self.intensity, np.nan)
        return show_images({name: distance, "intensity": intensity}, layouts)

    def plot(self, *, colour: str = "intensity", frame: str = "world", most: int = 20000) -> Any:
        """A matplotlib figure: the hits in space.

        Args:
            colour: a column of one number per point, such as range, incidence or status.
            frame: axes, as for ``cloud``.
            most: at most so many points are drawn, evenly picked.
        """
        cloud = self.cloud(["xyz", colour], frame=frame, hits_only=True)
        if cloud[colour].ndim != 1:
            raise Error("colour", shown(colour), "a column of one number per point, such as range")
        if whole(most, "most", MOST_32) == 0:
            raise Error("most", "0", "a whole number from 1")
        step = max(1, -(-cloud.points // most))
        return plot_points(cloud["xyz"][::step], cloud[colour][::step], colour, cloud.frame_id)

    def _repr_html_(self) -> str:
        told = {"beams": f"{self.rows} x {self.cols}", "hits": self.hits, "seed": self.seed, "frame": self.number}
        return html_table(told) + html_picture(self.save)

    def explain(
        self, index: int | None = None, *, row: int | None = None, col: int | None = None, hits_only: bool = False
    ) -> PointTrace:
        """How an entry came to be: the beam, what it met, the light, echoes, every step of noise with
        the random numbers that it drew. The frame is measured once more for it.

        Args:
            index: which point of a cloud of the frame, from 0; of one of hits alone with
                ``hits_only``. Or:
            row, col: which row and column of the frame's arrays.

        Raises:
            Error: there is no such entry.
        """
        return trace_of(_core.explain(self._with_renderer(), self._entry(index, row, col, hits_only)))

    def _entry(self, index: int | None, row: int | None, col: int | None, hits_only: bool) -> int:
        if index is None and row is not None and col is not None:
            return whole(row, "row", self.rows - 1) * self.cols + whole(col, "col", self.cols - 1)
        if index is None or row is not None or col is not None:
            raise Error("explain", "a point is named in two ways, or in none", "index, or row and col")
        if not hits_only:
            return whole(index, "index", self.rows * self.cols - 1)
        entries = np.flatnonzero(self.status == Status.hit)
        if len(entries) == 0:
            raise Error("index", f"{index}", "", "the frame has no hits")
        return int(entries[whole(index, "index", len(entries) - 1)])

    def information(
        self, *, sigma_m: float = 0.01, reference: npt.ArrayLike | None = None, instance: int | None = None
    ) -> FisherInformation:
        """What the frame can tell about the sensor's pose: Fisher's matrix and the bounds of any
        estimate. Needs normals (the usual columns have them).

        Args:
            sigma_m: of every range when the sensor has no noise.
            reference: sensor_from_reference, 4x4: where displacements count; None: the sensor's frame.
            instance: only returns of this object, by its place in the scene; None: of all.

        Raises:
            Error: normals were not kept, or a number is out of range.
        """
        pose = floats(np.eye(4) if reference is None else reference, "reference", (4, 4))[None]
        sigma = float(floats(sigma_m, "sigma_m", ()))
        objects = len(self._core.world_from_objects)
        only = None if instance is None else whole(instance, "instance", objects - 1)
        return FisherInformation(_core.information(self._core, sigma, pose, only))

    def __repr__(self) -> str:
        return f"<glidar.Frame {self.number} of {self.rows} x {self.cols} beams, {self.hits} hits, seed {self.seed}>"
