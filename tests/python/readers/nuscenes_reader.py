# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads a nuScenes data set with nuscenes-devkit and renders it; prints what it finds as JSON."""

import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import numpy as np  # noqa: E402
from nuscenes.nuscenes import NuScenes  # noqa: E402
from nuscenes.utils.data_classes import LidarPointCloud  # noqa: E402
from nuscenes.utils.geometry_utils import points_in_box  # noqa: E402

SLACK = 1.15  # factor of sizes: ranges have noise, and objects move while the beams are fired


def samples_of(data, scene):
    token = scene["first_sample_token"]
    while token:
        yield data.get("sample", token)
        token = data.get("sample", token)["next"]


def annotations_of(data, sample):
    """Each box as the devkit places it in the LiDAR's frame, and how many points of the scan are in it."""
    path, boxes, _ = data.get_sample_data(sample["data"]["LIDAR_TOP"])
    points = LidarPointCloud.from_file(path).points
    for box in boxes:
        record = data.get("sample_annotation", box.token)
        yield {"category": record["category_name"], "instance": record["instance_token"], "listed": record["num_lidar_pts"],
               "inside": int(points_in_box(box, points[:3], wlh_factor=SLACK).sum()),
               "visibility": data.get("visibility", record["visibility_token"])["level"],
               "attributes": [data.get("attribute", one)["name"] for one in record["attribute_tokens"]],
               "velocity": np.nan_to_num(data.box_velocity(box.token)).tolist(), "size": record["size"]}  # fmt: skip


def main(root, pictures):
    data = NuScenes("v1.0-mini", root, verbose=False)
    scans, keys = [], []
    for scene in data.scene:
        for sample in samples_of(data, scene):
            keys.append({"timestamp": sample["timestamp"], "channels": sorted(sample["data"]),
                         "annotations": list(annotations_of(data, sample))})  # fmt: skip
    for record in data.sample_data:
        if record["channel"] == "LIDAR_TOP":
            scan = np.fromfile(Path(root) / record["filename"], np.float32).reshape(-1, 5)
            scans.append({"points": len(scan), "intensity": [float(scan[:, 3].min()), float(scan[:, 3].max())],
                          "rings": len(np.unique(scan[:, 4])), "key": record["is_key_frame"]})  # fmt: skip
    first = data.sample[0]
    top, camera = first["data"]["LIDAR_TOP"], first["data"]["CAM_FRONT"]
    data.render_sample_data(top, out_path=f"{pictures}/lidar.png", verbose=False)
    data.render_sample_data(top, out_path=f"{pictures}/lidarseg.png", show_lidarseg=True, verbose=False)
    data.render_sample_data(camera, out_path=f"{pictures}/camera.png", verbose=False)
    data.render_pointcloud_in_image(first["token"], camera_channel="CAM_FRONT", out_path=f"{pictures}/projected.png", verbose=False)
    data.render_annotation(first["anns"][0], out_path=f"{pictures}/annotation.png")
    sweeps, _ = LidarPointCloud.from_file_multisweep(data, data.sample[1], "LIDAR_TOP", "LIDAR_TOP", nsweeps=3)
    print(json.dumps({"keys": keys, "scans": scans, "sweeps": sweeps.points.shape[1],
                      "classes": data.lidarseg_idx2name_mapping}))  # fmt: skip


main(*sys.argv[1:])
