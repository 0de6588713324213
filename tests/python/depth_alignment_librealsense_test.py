# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Aligned depth images have the pixels of librealsense (pyrealsense2), which computes in single precision."""

import numpy as np
import pytest
from librealsense import librealsense_aligned

import glidar

DEPTH = {"width": 160, "height": 120, "fx": 140.0, "fy": 142.0, "cx": 79.6, "cy": 59.3}
FINER = {"width": 240, "height": 180, "fx": 215.0, "fy": 212.0, "cx": 121.0, "cy": 88.4}
ANGLE = 0.02
ROTATION = np.array([[np.cos(ANGLE), 0, np.sin(ANGLE)], [0, 1, 0], [-np.sin(ANGLE), 0, np.cos(ANGLE)]])
TRANSLATION = np.array([0.015, 0.001, 0.0005])


def depths(seed):
    random = np.random.default_rng(seed)
    shape = (DEPTH["height"], DEPTH["width"])
    depth = 1000 + random.integers(0, 5, shape) + (np.arange(shape[1]) > 80) * 700
    return np.where(random.random(shape) < 0.1, 0, depth).astype(np.uint16)


@pytest.mark.parametrize("seed", range(3))
def test_pixels_are_equal(seed):
    pose = {"matrix": list(np.hstack([ROTATION, TRANSLATION[:, None]]).ravel())}
    cameras = {"depth": {**DEPTH, "pixel_centre": 0}, "colour": {**FINER, "pixel_centre": 0}, "colour_from_depth": pose}
    ours = glidar.DepthAligner({**cameras, "keeps_depth": True}).align(depths(seed)).depth
    theirs = librealsense_aligned(depths(seed), DEPTH, FINER, ROTATION, TRANSLATION)
    # corners that round to another pixel in single precision: about one in 2^24 / 240 pixels
    assert (ours != theirs).mean() < 1e-4, np.argwhere(ours != theirs)[:5]
