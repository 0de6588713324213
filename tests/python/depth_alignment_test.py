# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Depth images at the pixels of a colour camera."""

import numpy as np
import pytest

import glidar

DEPTH = {"width": 40, "height": 30, "pixel_centre": 0, "fx": 35.0, "fy": 36.0, "cx": 19.6, "cy": 14.8}
FINER = {"width": 60, "height": 44, "pixel_centre": 0.5, "fx": 56.0, "fy": 55.0, "cx": 31.0, "cy": 21.5}
COARSER = {"width": 24, "height": 18, "pixel_centre": 0, "fx": 22.0, "fy": 22.0, "cx": 12.0, "cy": 9.0}
BROWN = {"model": "radial_tangential", "k1": 0.12, "k2": -0.3, "p1": 0.001, "p2": -0.002, "k3": 0.1}
ANGLE = 0.02
ROTATION = np.array([[np.cos(ANGLE), 0, np.sin(ANGLE)], [0, 1, 0], [-np.sin(ANGLE), 0, np.cos(ANGLE)]])
POSITION = np.array([0.015, 0.001, 0.0005])
POSE = {"matrix": list(np.hstack([ROTATION, POSITION[:, None]]).ravel())}


def depths(camera=DEPTH):
    """A step of 0.7 m, with noise and holes."""
    random = np.random.default_rng(4)
    shape = (camera["height"], camera["width"])
    depth = 1000 + random.integers(0, 5, shape) + (np.arange(shape[1]) > shape[1] // 2) * 700
    return np.where(random.random(shape) < 0.1, 0, depth).astype(np.uint16)


def pixel(camera, point):
    """By OpenCV's documentation of the model, in double, one point at a time."""
    x, y = point[0] / point[2], point[1] / point[2]
    k = camera.get("distortion", {})
    r2 = x * x + y * y
    radial = 1 + k.get("k1", 0) * r2 + k.get("k2", 0) * r2**2 + k.get("k3", 0) * r2**3
    p1, p2 = k.get("p1", 0), k.get("p2", 0)
    u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    centre = camera["pixel_centre"]
    return camera["fx"] * u + camera["cx"] - centre, camera["fy"] * v + camera["cy"] - centre


def brute_force(depth, colour, keeps_depth):
    """Each colour pixel looks at all depth pixels, of which the nearest whose square covers it remains."""
    def moved(row, column, z):
        x = (column + DEPTH["pixel_centre"] - DEPTH["cx"]) / DEPTH["fx"]
        y = (row + DEPTH["pixel_centre"] - DEPTH["cy"]) / DEPTH["fy"]
        return ROTATION @ np.array([x * z, y * z, z]) + POSITION

    aligned = np.zeros((colour["height"], colour["width"]), int)
    source = np.full(aligned.shape, -1)
    for i, z in enumerate(depth.ravel()):
        if z == 0:
            continue
        row, column = divmod(i, depth.shape[1])
        corners = [pixel(colour, moved(row + d, column + d, z / 1000)) for d in (-0.5, 0.5)]
        (left, top), (right, bottom) = np.floor(np.sort(corners, axis=0) + 0.5)
        value = int(z) if keeps_depth else int(np.floor(1000 * moved(row, column, z / 1000)[2] + 0.5))
        for v in range(colour["height"]):
            for u in range(colour["width"]):
                if left <= u <= right and top <= v <= bottom and not 0 < aligned[v, u] <= value:
                    aligned[v, u], source[v, u] = value, i
    return aligned, source


@pytest.mark.parametrize("keeps_depth", [False, True])
@pytest.mark.parametrize("colour", [FINER, COARSER, {**FINER, "distortion": BROWN}], ids=["finer", "coarser", "distorted"])
def test_equals_its_definition(colour, keeps_depth):
    aligner = glidar.DepthAligner({"depth": DEPTH, "colour": colour, "colour_from_depth": POSE, "keeps_depth": keeps_depth})
    found = aligner.align(depths())
    aligned, source = brute_force(depths(), colour, keeps_depth)
    assert np.array_equal(found.depth, aligned)
    assert np.array_equal(found.source, source)


def test_the_same_camera_has_the_same_image():
    same = glidar.DepthAligner({"depth": DEPTH, "colour": DEPTH, "colour_from_depth": {"position": [0, 0, 0]}})
    # corners of neighbours round to the same pixel, where the nearer one remains
    flat = np.full((30, 40), 1234, np.uint16)
    assert np.array_equal(same.align(flat).depth, flat)


def test_occluded_depths_are_hidden_by_nearer_ones():
    colour = {**DEPTH, "width": 40}
    aligner = glidar.DepthAligner({"depth": DEPTH, "colour": colour, "colour_from_depth": {"position": [0.1, 0, 0]}})
    depth = np.full((30, 40), 3000, np.uint16)
    depth[:, 10:15] = 1000  # 3.5 px of parallax, the wall 1.2 px
    aligned = aligner.align(depth).depth
    assert set(np.unique(aligned)) == {0, 1000, 3000}
    assert (aligned[15, 14:18] == 1000).all()
    assert aligned[15, 12] == 0  # only the colour camera sees it


def test_metres_and_other_values_move_along():
    aligner = glidar.DepthAligner({"depth": DEPTH, "colour": FINER, "colour_from_depth": POSE})
    depth = depths()
    units, metres = aligner.align(depth), aligner.align(np.where(depth > 0, depth / 1000, np.nan))
    assert metres.depth.dtype == np.float32
    assert np.array_equal(np.nan_to_num(1000 * metres.depth).round(), units.depth)
    columns = units.take(np.broadcast_to(np.arange(40), (30, 40)), missing=-1)
    assert np.array_equal(columns, np.where(units.source < 0, -1, units.source % 40))
    assert np.array_equal(units.take(depth, missing=0) > 0, units.depth > 0)


@pytest.mark.parametrize("cameras, text", [
    ({"depth": DEPTH, "colour": FINER}, "colour_from_depth"),
    ({"depth": DEPTH, "rgb": FINER, "colour_from_depth": POSE}, "colour"),
    ({"depth": {**DEPTH, "width": 0}, "colour": FINER, "colour_from_depth": POSE}, "depth.width"),
    ("missing.yaml", "missing.yaml"),
])
def test_errors_name_what_is_wrong(cameras, text):
    with pytest.raises(glidar.Error, match=text):
        glidar.DepthAligner(cameras)


def test_images_of_another_size_are_refused():
    aligner = glidar.DepthAligner({"depth": DEPTH, "colour": FINER, "colour_from_depth": POSE})
    with pytest.raises(glidar.Error, match="40x30"):
        aligner.align(depths()[1:])
    with pytest.raises(glidar.Error, match="one value for each pixel"):
        aligner.align(depths()).take(np.zeros(3))
