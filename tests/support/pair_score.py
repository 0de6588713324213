# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""How well disparities agree with the depth that a camera reports for the same infrared pair."""

from dataclasses import dataclass

import numpy as np

FOLDER = "depth/d415_ir_pair"
SUBPIXEL_BINS = 16  # OpenCV's steps


@dataclass
class Score:
    fill_percent: float
    off_percent: float
    """Pixels that differ by more than 1 px, of those that both have."""
    spread_px: float
    """1.4826 times the median absolute difference."""
    overlap: float
    """Pixels that both have, over pixels that one has."""
    peak: float
    """Greatest over mean count of the fractions of disparities."""

    def __str__(self):
        return (f"fill {self.fill_percent:.1f} %, off {self.off_percent:.2f} %, spread {self.spread_px:.3f} px, "
                f"overlap {self.overlap:.3f}, peak {self.peak:.2f}")


def score(disparity_px, depth_mm):
    """Compares with disparities from the camera's depth, scaled and displaced to fit: f b / z + offset."""
    found, given = np.isfinite(disparity_px), depth_mm > 0
    both = found & given
    inverse, disparity = 1000.0 / depth_mm[both], disparity_px[both].astype(float)
    scale, offset = 24.6, 0.0  # f b, px m; refined below
    for _ in range(10):
        error = disparity - (scale * inverse + offset)
        near = np.abs(error - np.median(error)) < 1.0
        scale, offset = np.polyfit(inverse[near], disparity[near], 1)
    error = disparity - (scale * inverse + offset)
    bins = np.floor(np.mod(disparity_px[found], 1.0) * SUBPIXEL_BINS).astype(int)
    counts = np.bincount(bins, minlength=SUBPIXEL_BINS)
    return Score(100.0 * found.mean(), 100.0 * (np.abs(error) > 1.0).mean(),
                 1.4826 * float(np.median(np.abs(error - np.median(error)))),
                 both.sum() / (found | given).sum(), counts.max() / counts.mean())
