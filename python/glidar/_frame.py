# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Frames: measurements of a sensor, with ground truth."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._cloud import Cloud
from ._depth_images import DepthImages
from ._errors import Error
from ._fisher_information import FisherInformation, fisher_information_of
from ._inputs import FloatArray, column_list, log, path_of, text_list
from ._object_box import ObjectBox, boxes_of
from ._origin import Origin
from ._file_options import file_options, set_cloud, set_columns
from ._pictures import IMAGE, Picture, html_picture, html_table, picture_of, plot_cloud, set_picture, show_images
from ._state import Immutable, key_of, part, restoring, make_state
from ._status import ReturnSource, Status
from ._point_trace import PointTrace, entry_of, trace_of
from ._ground_truth import GroundTruth


class Frame(DepthImages, Immutable):
    """One measurement: what the sensor reports per beam, with the ground truth. Arrays are (rows, cols), read-only
    views of the frame's memory, which they keep alive.

    Two frames are equal when their poses, numbers and all kept columns are bit-identical. Frames can be hashed, copied
    and pickled. A pickle contains the columns, the sensor and the scene, whose files are read when they are needed.
    """

    __slots__ = ("_core", "_has_renderer", "_has_scene", "_origin")

    def __init__(self, core: _core.Frame, origin: Origin) -> None:
        self._core = core
        self._origin = origin
        self._has_scene = self._has_renderer = True

    def _with_scene(self) -> _core.Frame:
        """The frame with the scene that it measured."""
        if not self._has_scene:
            self._origin.attach_scene(self._core)
            self._has_scene = True
        return self._core

    def _with_renderer(self) -> _core.Frame:
        """The frame with its scene and renderer, so that it can be measured again."""
        if not self._has_renderer:
            self._origin.attach_renderer(self._core)
            self._has_renderer = True
        return self._core

    def __getstate__(self) -> dict[str, Any]:
        core = self._core
        return make_state("Frame", numbers=_core.frame_state(core), arrays=_core.frame_arrays(core), origin=self._origin)

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
        """Number of rows. With several returns, each return is a block of this many rows, stacked vertically."""
        return self._core.rows

    @property
    def cols(self) -> int:
        """Number of columns."""
        return self._core.cols

    @property
    def range_m(self) -> FloatArray:
        """Measured distance from the beam's origin, m; NaN unless hit. The column ``range`` adds the range offset."""
        return self._measured("range_m")

    @property
    def depth_m(self) -> FloatArray:
        """Measured distance of a camera along its boresight, m; NaN unless hit.

        Raises:
            Error: the sensor is a LiDAR, or a camera that also looks back.
        """
        if not self._core.has_depths:
            found = "the sensor has no image plane, along whose normal depths are measured"
            raise Error("depth_m", found, "a camera that looks ahead", "use range_m, or cloud(['depth'])")
        depths: FloatArray = self.cloud(["depth"])["depth"]
        depths.flags.writeable = False
        return depths

    @property
    def intensity(self) -> npt.NDArray[np.float32]:
        """Received signal; 0 unless status is hit. Its scale depends on the sensor (docs/sensors.md)."""
        return self._measured("intensity")

    @property
    def status(self) -> npt.NDArray[np.uint8]:
        """Why a beam has a return or none: values of ``Status``."""
        return self._measured("status")

    @property
    def return_source(self) -> npt.NDArray[np.uint8]:
        """The origin of each return: values of ``ReturnSource``."""
        found = self._core.measured("return_source")
        if found is not None:
            return found
        return np.where(self.status == Status.hit, np.uint8(ReturnSource.surface), np.uint8(ReturnSource.none))

    @property
    def sigma_m(self) -> npt.NDArray[np.float32]:
        """Standard deviation of the random error of range_m, m."""
        found = self._core.measured("sigma_m")
        return np.broadcast_to(np.float32(0.0), (self.rows, self.cols)) if found is None else found

    @property
    def radial_velocity_m_s(self) -> FloatArray:
        """Measured rate at which the range grows, m/s: positive for what moves away; NaN unless status is hit.

        Raises:
            Error: the sensor measures none: it has no ``doppler``.
        """
        found = self._core.measured("radial_velocity_m_s")
        if found is not None:
            return found
        remedy = "use a sensor with doppler, or ground_truth.radial_velocity_m_s"
        raise Error("radial_velocity_m_s", "the sensor does not measure it", "", remedy)

    def _measured(self, name: str) -> npt.NDArray[Any]:
        found = self._core.measured(name)
        assert found is not None
        return found

    @property
    def hits(self) -> int:
        """Number of beams with a return."""
        return int(np.count_nonzero(self.status == Status.hit))

    @property
    def ground_truth(self) -> GroundTruth:
        """The geometric ground truth of every beam."""
        return GroundTruth(self)

    @property
    def stamp_ns(self) -> int:
        """Time when the frame starts, ns."""
        return self._core.stamp_ns

    @property
    def seed(self) -> int:
        """Seed of its random numbers."""
        return self._core.seed

    @property
    def number(self) -> int:
        """Number of the frame in its sequence."""
        return self._core.number

    @property
    def sensor_id(self) -> int:
        """Number of the sensor in its rig, from 0."""
        return self._core.sensor_id

    @property
    def frame_id(self) -> str:
        """Name of the sensor's coordinate frame."""
        return self._core.frame_id

    @property
    def world_from_sensor(self) -> FloatArray:
        """The sensor's pose at stamp_ns, (4, 4), m."""
        return self._core.world_from_sensor

    @property
    def world_from_objects(self) -> FloatArray:
        """The objects' poses at stamp_ns, (k, 4, 4), m, without scale."""
        return np.array(self._core.world_from_objects).reshape(-1, 4, 4)

    def cloud(
        self,
        columns: str | Iterable[str] | None = None,
        *,
        frame: str = "sensor",
        drop_invalid: bool = False,
        deskew: bool = False,
    ) -> Cloud:
        """The measurement as a point cloud.

        Args:
            columns: names (docs/python.md), "all", or None for xyz, intensity, range, normal,
                instance, class.
            frame: coordinate frame: "sensor", "optical", "ros", "gl", "legacy" or "world".
            drop_invalid: whether to omit misses.
            deskew: whether points are computed with the sensor's pose at the firing time of their beam.

        Raises:
            Error: an unknown column or coordinate frame, or a column that the frame was measured without.
        """
        names = column_list(columns)
        if drop_invalid and "xyz" not in names:
            names.append("xyz")
        return Cloud(self._with_scene().cloud(names, frame, deskew, drop_invalid), drop_invalid)

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        columns: str | Iterable[str] | None = None,
        layout: str | None = None,
        frame: str | None = None,
        drop_invalid: bool = False,
        deskew: bool = False,
        pcd: str = "binary",
        ply_ascii: bool = False,
        depth_units_per_m: float = 1000.0,
        crs: str | os.PathLike[str] = "",
        sidecar: bool = True,
        colour_by: str = "height",
        picture_size: tuple[int, int] = (1400, 1000),
        view_eye: npt.ArrayLike | None = None,
        view_target: npt.ArrayLike | None = None,
    ) -> None:
        """Writes a file like ``glidar render -o PATH``. The suffix selects the format; ``output_formats()`` lists them.
        ``open_output`` writes several frames to a recording or a network. ``.npy`` of a LiDAR has ranges.

        Args:
            columns, frame, drop_invalid, deskew: as for ``cloud``. By default "sensor"; .las files are in "world" and
                deskewed.
            layout: point format of a sensor's driver instead of columns, such as "velodyne".
            pcd: "ascii", "binary" or "binary_compressed".
            ply_ascii: whether PLY files are text.
            depth_units_per_m: scale of 16-bit depth images; 1000 stores millimetres.
            crs: coordinate reference system of .las: "EPSG:CODE" of a UTM zone, well-known text, or a file with it.
            sidecar: whether to write NAME.glidar.json beside a cloud or image NAME.pcd.
            colour_by: of .bev.png and .view.png: "height", "range", "intensity", "ring", "class", "instance" or
                "radial_velocity".
            picture_size: width and height of .bev.png and .view.png, pixels.
            view_eye, view_target: of .view.png, (3,), m, in the cloud's coordinate frame; None: a view of most points.

        Raises:
            Error: an unknown suffix or layout, a missing folder, a column that was not kept, or an input file
            of the scene or sensor as the output. An existing file stays unchanged.
        """
        options = file_options(pcd, ply_ascii, depth_units_per_m)
        set_columns(options, columns, layout)
        set_cloud(options, frame, drop_invalid, deskew, crs, sidecar)
        target = path_of(path, "path")
        if "://" in target:
            raise Error("path", "the address of a network", "a file or folder", "send frames with open_output()")
        if not _core.is_frame_file(target):
            output = _core.Output(target, options)
            self.write_to(output)
            output.finish(log)
            return
        set_picture(options, colour_by, picture_size, view_eye, view_target)
        core = self._with_scene()
        if core.needs_boxes(target, options):
            core = self._with_renderer()
        core.save(target, options, log)

    def write_to(self, output: _core.Output) -> None:
        """Adds it to an output; see ``open_output``."""
        core = self._with_scene()
        output.write(self._with_renderer() if _core.lacks_boxes(core) else core, log)

    def boxes(
        self, *, frame: str = "sensor", classes: Iterable[str] | None = None, unlabelled: bool = False
    ) -> list[ObjectBox]:
        """3D bounding boxes of objects when the frame starts, in the order of ``Scene.objects``, with the number of
        points and the occlusion (docs/boxes.md). The first call casts beams into each object alone.

        Args:
            frame: coordinate frame, as for ``cloud``.
            classes: names of the classes whose objects have boxes; None: ``Scene.box_classes``, by default the
                countable ones, so not those of roads, buildings and terrain.
            unlabelled: whether all objects have boxes, also those without a class.

        Raises:
            Error: an unknown coordinate frame or class.
        """
        names = [] if classes is None else text_list(classes, "classes")
        if classes is not None and not names and not unlabelled:
            return []
        return boxes_of(self._with_renderer(), frame, unlabelled, names)

    def bird_eye(
        self, *, colour_by: str = "height", size: tuple[int, int] = (1400, 1000), frame: str = "sensor"
    ) -> Picture:
        """The hits from above, x to the right and y up, with axes in metres, like .bev.png of ``save``.

        Args:
            colour_by, size: as colour_by and picture_size of ``save``.
            frame: coordinate frame, as for ``cloud``.

        Raises:
            Error: colours by ring for a camera, or an unknown name.
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
        """The hits in perspective, with a grid on the ground, like .view.png of ``save``.

        Args:
            colour_by, size, eye, target: as colour_by, picture_size, view_eye and view_target of
                ``save``.
            frame: coordinate frame, as for ``cloud``.

        Raises:
            Error: colours by ring for a camera, an unknown name, or an eye at the target.
        """

        def write(path: Path) -> None:
            self.save(path, colour_by=colour_by, picture_size=size, frame=frame, view_eye=eye, view_target=target)

        return picture_of(write, "picture.view.png")

    def show(self) -> Any:
        """A matplotlib figure of depth (for LiDARs: range) and intensity as images. Images of LiDARs have axes of azimuth
        and elevation, or x and y from above. Jupyter displays it; elsewhere call ``matplotlib.pyplot.show()``."""
        layouts = [self._core.picture(number) for number in range(self._core.returns)]
        is_camera = layouts[0].kind == IMAGE
        name, distance = ("depth, m", self.cloud(["depth"])["depth"]) if is_camera else (
            "range, m", self.range_m + self._core.range_offset_m)
        intensity = np.where(np.isfinite(distance), self.intensity, np.nan)
        return show_images({name: distance, "intensity": intensity}, layouts)

    def plot(self, *, colour: str = "intensity", frame: str = "world", max_points: int = 20000) -> Any:
        """A matplotlib figure of the hits in 3D.

        Args:
            colour: a column with one number per point, such as range, incidence or status.
            frame: coordinate frame, as for ``cloud``.
            max_points: maximum number of points in the figure; an even selection of the hits.

        Raises:
            Error: an unknown column, or one that has several numbers per point.
        """
        return plot_cloud(self.cloud(["xyz", colour], frame=frame, drop_invalid=True), colour, max_points)

    def _repr_html_(self) -> str:
        rows = {"beams": f"{self.rows} x {self.cols}", "hits": self.hits, "seed": self.seed, "frame": self.number}
        return html_table(rows) + html_picture(self.save)

    def explain(
        self, index: int | None = None, *, row: int | None = None, col: int | None = None, drop_invalid: bool = False
    ) -> PointTrace:
        """Traces how the measurement of an entry arose: beam, hit, received signal, echoes, and every noise step with
        its random numbers. For this the frame is measured again.

        Args:
            index: index of a point of a cloud of the frame, from 0; with ``drop_invalid``, of a cloud of hits. Or:
            row, col: row and column of the frame's arrays.

        Raises:
            Error: there is no such entry.
        """
        entry = entry_of(self.status, index, row, col, drop_invalid)
        return trace_of(_core.explain(self._with_renderer(), entry))

    def fisher_information(
        self, *, sigma_m: float = 0.01, reference: npt.ArrayLike | None = None, instance: int | None = None
    ) -> FisherInformation:
        """Fisher information of the frame about the sensor's pose, and the bounds of any estimate. Requires
        normals, which the default columns include.

        Args:
            sigma_m: standard deviation of every range, m, when the sensor has no noise.
            reference: sensor_from_reference, (4, 4), m: frame of the displacements; None: the sensor's frame.
            instance: index of the object whose returns contribute; None: all objects.

        Raises:
            Error: normals were not kept, or a number is out of range.
        """
        return fisher_information_of(self._core, sigma_m, reference, instance)

    def __repr__(self) -> str:
        return f"<glidar.Frame {self.number} of {self.rows} x {self.cols} beams, {self.hits} hits, seed {self.seed}>"
