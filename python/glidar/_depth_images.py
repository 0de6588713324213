# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Raw images of depth cameras, from which the ranges of a frame were decoded."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from ._core import Frame as CoreFrame
from ._tof import TofFrame, tof_frame

MAX_BYTE = 255


@dataclasses.dataclass(frozen=True, eq=False)
class RawImage:
    """An image of a depth camera, (rows, cols)."""

    grey: npt.NDArray[np.uint8] | npt.NDArray[np.uint16]
    """Grey levels as the imager reports them."""
    electrons: npt.NDArray[np.float32] | None
    """Ground truth: the mean number of electrons, without noise and speckle. None for the stored reference picture."""


class DepthImages:
    """What frames of depth cameras with ``depth_model`` "physical" have besides their ranges."""

    __slots__ = ()
    _core: CoreFrame

    @property
    def tof(self) -> TofFrame | None:
        """Raw images of a time-of-flight camera with ``depth_model`` "physical". None for other sensors."""
        return tof_frame(self._core)

    @property
    def disparity_px(self) -> npt.NDArray[np.float32] | None:
        """Disparity of a stereo camera with ``depth_model`` "physical", pixels; NaN without a match. None for other
        sensors."""
        return self._core.measured("disparity_px")

    @property
    def projector_px(self) -> npt.NDArray[np.float32] | None:
        """Column (or row) of the projector of a structured-light camera with ``depth_model`` "physical", whole numbers
        are centres of pixels; NaN where it is not decoded. None for other sensors."""
        return self._core.measured("projector_px")

    @property
    def raw_images(self) -> dict[str, RawImage]:
        """The images from which the depths were decoded, by name: "ir_left" and "ir_right" or "ir_reference";
        of structured-light cameras "pattern_00", "pattern_01" ... in the order of the patterns. Empty unless
        ``depth_model`` is "physical"."""
        return {name: RawImage(levels.astype(np.uint8) if max_level <= MAX_BYTE else levels, electrons)
                for name, max_level, levels, electrons in self._core.raw_images()}
