# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads a sequence of SemanticKITTI with semantic-kitti-api, as its visualize.py does; prints what it finds as JSON."""

import json
import sys
from pathlib import Path

import numpy as np
import yaml
from auxiliary.laserscan import SemLaserScan

sequence = Path(sys.argv[1]) / "sequences" / "00"
config = yaml.safe_load((sequence / "semantic-kitti.yaml").read_text())
found = []
for scan_path, label_path in zip(sorted(sequence.glob("velodyne/*.bin")), sorted(sequence.glob("labels/*.label")), strict=True):
    scan = SemLaserScan(config["color_map"], project=True)
    scan.open_scan(str(scan_path))
    scan.open_label(str(label_path))
    scan.colorize()
    found.append({"points": len(scan.points), "classes": [config["labels"][one] for one in np.unique(scan.sem_label).tolist()],
                  "instances": np.unique(scan.inst_label).tolist(),
                  "coloured": int((scan.sem_label_color.sum(axis=1) > 0).sum())})  # fmt: skip
print(json.dumps({"scans": found, "learned": config["learning_map"]}))
