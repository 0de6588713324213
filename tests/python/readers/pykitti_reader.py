# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads a sequence of KITTI's odometry benchmark with pykitti; prints what it finds as JSON."""

import json
import sys

import numpy as np
import pykitti

data = pykitti.odometry(sys.argv[1], "00")
print(json.dumps({
    "frames": len(data), "times": [one.total_seconds() for one in data.timestamps],
    "poses": [one.tolist() for one in data.poses], "scans": [len(one) for one in data.velo],
    "images": [np.asarray(image).shape for image in data.cam2], "first_image": np.asarray(data.get_cam2(0)).tolist(),
    "K": data.calib.K_cam2.tolist(), "cam0_from_velo": data.calib.T_cam0_velo.tolist(),
    "cam2_from_velo": data.calib.T_cam2_velo.tolist(), "P3": data.calib.P_rect_30.tolist()}))  # fmt: skip
