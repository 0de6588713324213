# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The stereo matcher and OpenCV's semi-global matcher, on the infrared pair of a RealSense D415 with the camera's own
depth (GLIDAR_DATA), and on generated pairs."""

import itertools
import os
import unittest
from pathlib import Path

import numpy as np
import pytest
from pair_score import FOLDER, score

import glidar

cv2 = pytest.importorskip("cv2")
DATA = os.environ.get("GLIDAR_DATA")
SEARCH = 128


def opencv_disparity(left, right, block_px, mode=cv2.STEREO_SGBM_MODE_HH, uniqueness=15, disparities=SEARCH):
    """With the penalties of OpenCV's documentation, and the same left-right test as ours."""
    area = block_px * block_px
    matcher = cv2.StereoSGBM_create(0, disparities, block_px, 8 * area, 32 * area, 1, uniquenessRatio=uniqueness, mode=mode)
    disparity = matcher.compute(left, right)
    return np.where(disparity > 0, disparity / 16.0, np.nan)


def dots(shift_px, width=320, height=160):
    """Random Gaussian dots of 0.9 px at exact positions; those of the left image are shift_px further right."""
    random = np.random.default_rng(3)
    count = int(0.06 * (width + 100) * height)
    column, row = random.uniform(-100, width, count), random.uniform(0, height, count)
    images = []
    for shift in (shift_px, 0.0):
        image = np.full((height, width), 20.0)
        u, v = np.floor(column + shift).astype(int), np.floor(row).astype(int)
        for dx in range(-5, 6):
            for dy in range(-5, 6):
                x, y = u + dx, v + dy
                inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
                r2 = (x - column - shift) ** 2 + (y - row) ** 2
                np.add.at(image, (y[inside], x[inside]), 150.0 * np.exp(-r2[inside] / (2 * 0.9**2)))
        images.append(np.clip(np.round(image), 0, 255).astype(np.uint8))
    return images


class RealPair(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not DATA:
            raise unittest.SkipTest("GLIDAR_DATA is not set; set it to a folder with real data")
        folder = Path(DATA, FOLDER)
        cls.left, cls.right = (cv2.imread(str(folder / f"0000_ir_{eye}.png"), cv2.IMREAD_GRAYSCALE) for eye in "lr")
        cls.depth_mm = cv2.imread(str(folder / "0000_depth.png"), cv2.IMREAD_UNCHANGED).astype(float)
        cls.ours = score(glidar.match_stereo(cls.left, cls.right).disparity_px, cls.depth_mm)

    def test_agrees_with_the_camera_s_own_depth(self):
        self.assertLessEqual(self.ours.off_percent, 1.5, self.ours)
        self.assertLessEqual(self.ours.spread_px, 0.15, self.ours)
        self.assertGreaterEqual(self.ours.overlap, 0.94, self.ours)
        self.assertLessEqual(self.ours.peak, 1.6, self.ours)

    def test_is_better_than_opencv_by_every_measure(self):
        modes = (cv2.STEREO_SGBM_MODE_HH, cv2.STEREO_SGBM_MODE_SGBM)
        for block_px, mode, uniqueness in itertools.product((5, 7), modes, (5, 15)):
            disparity = opencv_disparity(self.left, self.right, block_px, mode, uniqueness)
            theirs = score(disparity, self.depth_mm)
            with self.subTest(f"blocks of {block_px}, mode {mode}, {uniqueness} %: {theirs}; ours: {self.ours}"):
                self.assertGreater(self.ours.fill_percent, theirs.fill_percent)
                self.assertLess(self.ours.off_percent, theirs.off_percent)
                self.assertLess(self.ours.spread_px, theirs.spread_px)
                self.assertGreater(self.ours.overlap, theirs.overlap)
                self.assertLess(self.ours.peak, theirs.peak)

    def test_has_the_camera_s_band_without_depth_on_the_left(self):
        match = glidar.match_stereo(self.left, self.right)
        ours = np.argmax(np.isfinite(match.disparity_px), axis=1)
        camera = np.argmax(self.depth_mm > 0, axis=1)
        self.assertLessEqual(abs(np.median(ours) - np.median(camera)), 3)


class GeneratedPair(unittest.TestCase):
    def test_both_matchers_find_whole_and_half_disparities(self):
        for shift_px in (20.0, 20.5):
            left, right = dots(shift_px)
            ours = np.nanmedian(glidar.match_stereo(left, right, glidar.StereoOptions(disparities=48)).disparity_px)
            theirs = np.nanmedian(opencv_disparity(left, right, 5, disparities=48))
            with self.subTest(f"{shift_px} px: {ours} and {theirs}"):
                self.assertLessEqual(abs(ours - shift_px), 0.1)
                self.assertLessEqual(abs(theirs - shift_px), 0.1)
