# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Depth filters have the bytes of librealsense (pyrealsense2)."""

import itertools

import numpy as np
import pytest
from librealsense import librealsense_filters

import glidar

FOCAL_LENGTH_PX, BASELINE_M = 382.6, 0.05
TO_DISPARITY, TO_DEPTH = {"type": "to_disparity", "baseline_m": BASELINE_M}, {"type": "to_depth"}
KINDS = ("steps", "with depths near 0", "any depths")


def images(kind, count=12, rows=37, columns=54):
    random = np.random.default_rng(7)
    y, x = np.mgrid[:rows, :columns]
    result = []
    for _ in range(count):
        depth = 900 + 3 * x + 2 * y + (x > columns // 2) * 500 + random.integers(-12, 13, (rows, columns))
        if kind == "with depths near 0":
            depth = np.where(random.random((rows, columns)) < 0.2, random.integers(0, 30, (rows, columns)), depth)
        if kind == "any depths":
            depth = random.integers(0, 65536, (rows, columns))
        depth = np.where(random.random((rows, columns)) < 0.15, 0, depth)
        depth[rows // 3:rows // 2, columns // 4:columns // 4 + 9] = 0
        result.append(depth.astype(np.uint16))
    return result


def require_equal(filters, count=1):
    for kind in KINDS:
        given = images(kind, count)
        ours = glidar.DepthFilters(filters, focal_length_px=FOCAL_LENGTH_PX)
        theirs = librealsense_filters(filters, given, FOCAL_LENGTH_PX, BASELINE_M)
        for i, (image, expected) in enumerate(zip(given, theirs)):
            assert np.array_equal(ours.apply(image), expected), (filters, kind, i)


def test_decimation():
    for magnitude in range(1, 9):
        require_equal([{"type": "decimation", "magnitude": magnitude}])


def test_threshold():
    for min_m, max_m in ((0.1, 4.0), (0.95, 1.2), (0.0, 16.0)):
        require_equal([{"type": "threshold", "min_m": min_m, "max_m": max_m}])


def test_conversions():
    require_equal([TO_DISPARITY, TO_DEPTH])


@pytest.mark.parametrize("domain", ["depths", "disparities"])
def test_spatial(domain):
    widths = ("none", "2", "4", "8", "16", "unlimited")
    for alpha, delta, magnitude, width in itertools.product((0.25, 0.5, 0.71, 1.0), (1, 8, 20, 50), (1, 2, 5), widths):
        spatial = {"type": "spatial", "alpha": alpha, "delta": delta, "magnitude": magnitude, "hole_filling": width}
        require_equal([TO_DISPARITY, spatial, TO_DEPTH] if domain == "disparities" else [spatial])


@pytest.mark.parametrize("domain", ["depths", "disparities"])
def test_temporal(domain):
    for alpha, delta, persistence in itertools.product((0.0, 0.1, 0.4, 1.0), (1, 20, 100), range(9)):
        temporal = {"type": "temporal", "alpha": alpha, "delta": delta, "persistence": persistence}
        require_equal([TO_DISPARITY, temporal, TO_DEPTH] if domain == "disparities" else [temporal], count=12)


@pytest.mark.parametrize("source", ["left", "farthest", "nearest"])
def test_hole_filling(source):
    require_equal([{"type": "hole_filling", "source": source}])
    require_equal([TO_DISPARITY, {"type": "hole_filling", "source": source}, TO_DEPTH])


def test_recommended_filters():
    require_equal(glidar.recommended_depth_filters(), count=12)
    require_equal(glidar.recommended_depth_filters(BASELINE_M), count=12)
    with_threshold = [{"type": "decimation", "magnitude": 3}, {"type": "threshold", "max_m": 1.5}]
    require_equal(with_threshold + glidar.recommended_depth_filters(BASELINE_M)[1:], count=12)
