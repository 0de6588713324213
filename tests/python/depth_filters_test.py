# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Depth filters with NumPy arrays."""

import numpy as np
import pytest

import glidar

IMAGE = np.array([[1000, 1010, 1000, 1000], [1000, 0, 1005, 1000], [1000, 1000, 1000, 1000]], np.uint16)


def test_filters_are_names_or_dicts():
    by_name = glidar.DepthFilters(["spatial", "hole_filling"]).apply(IMAGE)
    spatial = {"type": "spatial", "alpha": 0.5, "delta": 20, "magnitude": 2, "hole_filling": "none"}
    by_dict = glidar.DepthFilters([spatial, {"type": "hole_filling", "source": "farthest"}]).apply(IMAGE)
    assert by_name.dtype == np.uint16 and np.array_equal(by_name, by_dict)
    assert by_name[1, 1] > 0


def test_recommended_filters_have_all_their_keys():
    types = [keys["type"] for keys in glidar.recommended_depth_filters(0.05)]
    assert types == ["decimation", "to_disparity", "spatial", "temporal", "to_depth", "hole_filling"]
    assert [keys["type"] for keys in glidar.recommended_depth_filters()] == [t for t in types if not t.startswith("to_")]
    assert glidar.recommended_depth_filters(0.05)[1]["baseline_m"] == 0.05
    assert glidar.recommended_depth_filters()[2] == {"type": "temporal", "alpha": 0.4, "delta": 20, "persistence": 3}


def test_metres_are_filtered_as_their_multiples_of_the_unit():
    filters = ["spatial", {"type": "hole_filling", "source": "nearest"}]
    units = glidar.DepthFilters(filters).apply(IMAGE)
    metres = glidar.DepthFilters(filters).apply(np.where(IMAGE > 0, IMAGE / 1000, np.nan))
    assert metres.dtype == np.float32
    assert np.array_equal(metres, np.where(units > 0, units / 1000, np.nan).astype(np.float32), equal_nan=True)
    far = glidar.DepthFilters([]).apply(np.array([[70.0, 0.0004, 0.0005]]))
    assert np.array_equal(far, np.array([[np.nan, np.nan, 0.001]], np.float32), equal_nan=True)


def test_strides_do_not_matter():
    filters = glidar.DepthFilters(["spatial"])
    assert np.array_equal(filters.apply(IMAGE[:, ::-1]), filters.apply(IMAGE[:, ::-1].copy()))


def test_reset_forgets_the_images_before():
    filters = glidar.DepthFilters(["temporal"])
    first = filters.apply(IMAGE)
    assert np.array_equal(first, IMAGE)
    assert not np.array_equal(filters.apply(IMAGE + 10), IMAGE + 10)
    filters.reset()
    assert np.array_equal(filters.apply(IMAGE + 10), IMAGE + 10)


@pytest.mark.parametrize("filters, text", [
    (["spacial"], "spatial"),
    ([{"type": "spatial", "alfa": 0.5}], "alpha"),
    ([{"type": "spatial", "alpha": 2}], "0.25 to 1"),
    ([{"type": "temporal", "persistence": 9}], "0 to 8"),
    (["to_disparity", "to_depth"], "baseline_m"),
    (["to_depth"], "to_disparity"),
    ([3], "name of a filter"),
    ("spatial", "a list of filters"),
])
def test_errors_name_what_is_allowed(filters, text):
    with pytest.raises(glidar.Error, match=text):
        glidar.DepthFilters(filters)


def test_disparities_need_the_focal_length():
    with pytest.raises(glidar.Error, match="focal_length_px"):
        glidar.DepthFilters([{"type": "to_disparity", "baseline_m": 0.05}, "to_depth"])


def test_images_of_other_types_are_refused():
    for image in (IMAGE.astype(np.int32), IMAGE[0], [["a"]]):
        with pytest.raises(glidar.Error, match="uint16"):
            glidar.DepthFilters([]).apply(image)
