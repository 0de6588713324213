# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Stereo matching with NumPy arrays."""

import numpy as np
import pytest

import glidar

OPTIONS = glidar.StereoOptions(disparities=64)


@pytest.fixture(scope="module")
def pair():
    return glidar.sample_stereo_pair()


def brute_force(left, right, options):
    """Path costs summed over all paths, by their definition, one number at a time."""
    rows, columns = left.shape
    count, area = options.disparities, options.box_px**2
    p1, p2 = round(options.p1 * area), round(options.p2 * area)

    def census(image):
        padded = np.pad(image.astype(int), 3, mode="edge")
        shifts = [(dy, dx) for dy in range(7) for dx in range(7) if (dy, dx) != (3, 3)]
        return np.stack([padded[dy:dy + rows, dx:dx + columns] < image for dy, dx in shifts], axis=-1)

    first, second = census(left), census(right)
    hamming = np.full((rows, columns, count), 24)  # half of the 48 bits where the right image ends
    for d in range(count):
        hamming[:, d:, d] = (first[:, d:] != second[:, :columns - d]).sum(axis=-1)
    r = options.box_px // 2
    padded = np.pad(hamming, ((r, r), (r, r), (0, 0)), mode="edge")
    cost = sum(padded[dy:dy + rows, dx:dx + columns] for dy in range(2 * r + 1) for dx in range(2 * r + 1))
    total = np.zeros_like(cost)
    straight = [(0, 1), (0, -1), (1, 0), (-1, 0)]
    for dy, dx in straight + [(1, 1), (1, -1), (-1, 1), (-1, -1)] * (options.paths == 8):
        path = np.zeros_like(cost)
        for y in range(rows)[::dy or 1]:
            for x in range(columns)[::dx or 1]:
                path[y, x] = cost[y, x]
                if 0 <= y - dy < rows and 0 <= x - dx < columns:
                    before = path[y - dy, x - dx]
                    steps = np.pad(before, 1, constant_values=10**6) + p1
                    path[y, x] += np.minimum.reduce(
                        [before, steps[:-2], steps[2:], np.full(count, before.min() + p2)]) - before.min()
        total += path
    return total


@pytest.mark.parametrize("paths", [4, 8])
def test_costs_equal_their_definition(paths):
    random = np.random.default_rng(5)
    right = random.integers(0, 256, (30, 40), np.uint8)
    left = np.roll(right, 5, axis=1)
    options = glidar.StereoOptions(disparities=16, paths=paths)
    match = glidar.match_stereo(left, right, options, costs=True)
    assert np.array_equal(match.costs, brute_force(left, right, options))


def test_result_has_a_disparity_exactly_where_the_status_is_valid(pair):
    match = glidar.match_stereo(*pair, OPTIONS)
    assert match.disparity_px.dtype == np.float32 and match.disparity_px.shape == (200, 320)
    assert match.status.dtype == np.uint8 and match.status.shape == (200, 320)
    assert np.array_equal(np.isfinite(match.disparity_px), match.status == glidar.StereoStatus.valid)
    assert match.costs is None


def test_sample_has_the_disparities_and_causes_that_it_states(pair):
    match = glidar.match_stereo(*pair, OPTIONS)
    assert round(float(match.disparity_px[90, 190])) == 36
    assert round(float(match.disparity_px[20, 300])) == 12
    names = {glidar.StereoStatus(one).name for one in np.unique(match.status)}
    assert {"valid", "border", "no_texture", "saturated", "left_right"} <= names


def test_default_options_are_those_of_the_library():
    for field in ("min_disparity_px", "disparities", "box_px", "paths", "p1", "p2", "a_factor", "uniqueness_percent",
                  "has_left_right_test", "left_right_px", "min_texture", "saturation_level", "steps_per_px"):
        assert getattr(glidar.StereoOptions(), field) == getattr(glidar._core.StereoOptions(), field), field
    assert glidar._core.StereoOptions().census == 1 and glidar._core.StereoOptions().subpixel == 0


def test_strided_arrays_match_as_their_copies(pair):
    left, right = (np.repeat(image, 2, axis=1)[:, ::2] for image in pair)
    assert not left.flags.c_contiguous
    expected = glidar.match_stereo(*pair, OPTIONS)
    assert np.array_equal(glidar.match_stereo(left, right, OPTIONS).disparity_px, expected.disparity_px, equal_nan=True)


def test_result_is_the_same_for_every_number_of_threads(pair):
    one, two, eight = (glidar.match_stereo(*pair, OPTIONS, threads=n).disparity_px.tobytes() for n in (1, 2, 8))
    assert one == two == eight


def test_uint16_images_match_as_uint8(pair):
    expected = glidar.match_stereo(*pair, OPTIONS)
    wide = glidar.match_stereo(*(image.astype(np.uint16) * 257 for image in pair), OPTIONS)
    assert np.array_equal(wide.status, expected.status)


def test_depth_is_focal_length_times_baseline_over_disparity(pair):
    match = glidar.match_stereo(*pair, OPTIONS)
    depth = match.depth_m(focal_length_px=430.0, baseline_m=0.05, depth_unit_m=0.0)
    valid = np.isfinite(match.disparity_px)
    assert np.allclose(depth[valid], 21.5 / match.disparity_px[valid], rtol=1e-6)
    assert np.isnan(depth[~valid]).all()


def test_explain_reports_the_costs_and_the_test_that_failed(pair):
    match = glidar.match_stereo(*pair, OPTIONS, costs=True)
    row, column = np.argwhere(match.status == glidar.StereoStatus.left_right)[0]
    trace = glidar.explain_stereo(*pair, OPTIONS, column=int(column), row=int(row))
    assert trace.status == glidar.StereoStatus.left_right
    assert [test.name for test in trace.tests if not test.passed] == ["left_right"]
    assert np.array_equal(trace.summed_cost, match.costs[row, column])
    assert trace.winner_px == int(np.argmin(trace.summed_cost))
    assert "failed  left_right" in str(trace)


@pytest.mark.parametrize("left, right, message", [
    (np.zeros((4, 40)), np.zeros((4, 40), np.uint8), "left image: an array of float64; allowed: an array rows x columns"),
    (np.zeros((4, 40, 3), np.uint8), np.zeros((4, 40), np.uint8), "left image: an array of 3 dimensions"),
    (np.zeros((4, 40), np.uint8), np.zeros((4, 40), np.uint16), "right image: an array of uint16, the left one of uint8"),
    (np.zeros((4, 80), np.uint8), np.zeros((4, 81), np.uint8), "right image: has 81x4 pixels, the left one 80x4"),
    (np.zeros((0, 0), np.uint8), np.zeros((0, 0), np.uint8), "left image: has no pixels: 0x0"),
    (np.zeros((1, 1), np.uint8), np.zeros((1, 1), np.uint8), "wider than the image"),
    ([[1, 2], [3]], np.zeros((4, 40), np.uint8), "left image: not an array"),
    (None, np.zeros((4, 40), np.uint8), "left image: an array of object"),
])
def test_bad_images_are_errors(left, right, message):
    with pytest.raises(glidar.Error, match=message):
        glidar.match_stereo(left, right, OPTIONS)


@pytest.mark.parametrize("options, message", [
    ({"census": "5x5"}, "stereo option census: '5x5'; allowed: 9x9, 7x7, 7x7-symmetric"),
    ({"box_px": 4}, "box_px: is even: 4"),
    ({"p1": float("nan")}, "p1: is nan"),
    ({"p2": "high"}, "p2: 'high'; allowed: a number"),
    ({"disparities": -1}, "disparities: -1"),
    ({"disparities": 5000}, "disparities: is 5000"),
])
def test_bad_options_are_errors(pair, options, message):
    with pytest.raises(glidar.Error, match=message):
        glidar.match_stereo(*pair, glidar.StereoOptions(**options))
