# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The code of pages that need packages from PyPI works. For the other pages see tests/docs_test.py."""

import re
import sys
import types

import numpy as np
import pytest
from cloud_message import points_of
from doc_blocks import ROOT, link_inputs, run_page

import glidar

NAME = "tests/python/pages_test.py"
PAGES = ["docs/tutorial/3-data-set.md", "docs/tutorial/5-survey.md", "docs/cookbook.md", "docs/boxes.md", "docs/doppler.md",
         "docs/stereo.md", "docs/time-of-flight.md", "docs/depth-filters.md", "docs/structured-light.md", "docs/files/kitti.md",
         "docs/files/nuscenes.md", "docs/files/parts.md"]


@pytest.mark.parametrize("page", PAGES)
def test_the_code_blocks_of_a_page_run(page, tmp_path):
    link_inputs(tmp_path)
    run_page(page, NAME, tmp_path)


class StandIn(types.SimpleNamespace):
    """A ROS message: its fields are set by name."""

    FLOAT32, FLOAT64, UINT8, UINT16, UINT32 = 7, 8, 2, 4, 6  # datatypes of sensor_msgs/PointField


def test_the_ros_message_of_the_cookbook_has_the_points_of_the_file(tmp_path, monkeypatch):
    for name in ("sensor_msgs", "sensor_msgs.msg", "std_msgs", "std_msgs.msg"):
        module = types.ModuleType(name)
        module.PointCloud2 = module.PointField = module.Header = StandIn
        monkeypatch.setitem(sys.modules, name, module)
    text = (ROOT / "docs/cookbook.md").read_text(encoding="utf-8")
    names = {}
    exec(re.search(r"```python\n(from sensor_msgs.*?)```", text, re.DOTALL)[1], names)
    frame = glidar.simulate(glidar.Scene("builtin:box"), "VLP-16", np.eye(4))
    frame.save(tmp_path / "scan.pcd", layout="autoware")
    message = names["to_message"](tmp_path / "scan.pcd", StandIn())
    assert (message.height, message.width, message.point_step) == (16, frame.range_m.shape[1], 32)
    assert np.array_equal(points_of(message)["distance"], frame.cloud(["range"])["range"].astype("f4"), equal_nan=True)
