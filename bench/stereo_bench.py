#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The stereo matcher and OpenCV's semi-global matcher with one thread, in turn: 848x480 pixels, 128 disparities.

usage: PYTHONPATH=build/dev/python build/venv/bin/python bench/stereo_bench.py [ROUNDS]
Times are of the processor; medians, and their ratio: above 1, GLIDAR is faster. OpenCV keeps its memory from call to
call, and glidar.match_stereo() allocates it each time (build/dev/bench/stereo_bench measures without that).
"""

import statistics
import sys
import time

import cv2
import numpy as np

import glidar

WIDTH, HEIGHT, SEARCH, SHIFT, BLOCK = 848, 480, 128, 40, 5
MODES = {"8 paths (MODE_HH)": (cv2.STEREO_SGBM_MODE_HH, 8), "5 paths (MODE_SGBM), ours 8": (cv2.STEREO_SGBM_MODE_SGBM, 8),
         "4 paths (MODE_HH4)": (cv2.STEREO_SGBM_MODE_HH4, 4)}


def seconds(work):
    start = time.process_time()
    work()
    return time.process_time() - start


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 9
    cv2.setNumThreads(1)
    random = np.random.default_rng(1)
    right = random.integers(0, 256, (HEIGHT, WIDTH), np.uint8)
    left = np.roll(right, SHIFT, axis=1)
    for name, (mode, paths) in MODES.items():
        area = BLOCK * BLOCK
        theirs = cv2.StereoSGBM_create(0, SEARCH, BLOCK, 8 * area, 32 * area, 1, uniquenessRatio=15, mode=mode)
        options = glidar.StereoOptions(disparities=SEARCH, box_px=BLOCK, paths=paths)

        def match_ours(chosen=options):
            glidar.match_stereo(left, right, chosen, threads=1)

        def match_theirs(matcher=theirs):
            matcher.compute(left, right)

        pairs = [(seconds(match_ours), seconds(match_theirs)) for _ in range(rounds + 1)][1:]  # the first one warms up
        ours_s, theirs_s = (statistics.median(times) for times in zip(*pairs, strict=True))
        print(f"{name:<28} ours {1e3 * ours_s:6.1f} ms   OpenCV {1e3 * theirs_s:6.1f} ms   "
              f"ratio {theirs_s / ours_s:.2f}", flush=True)


if __name__ == "__main__":
    main()
