# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""sensor_msgs/PointCloud2 as any library decodes it."""

import numpy as np

TYPES = {2: "u1", 4: "<u2", 6: "<u4", 7: "<f4", 8: "<f8"}  # datatypes of sensor_msgs/PointField


def points_of(cloud):
    """The points as a structured array in the shape of the message."""
    kind = np.dtype({"names": [field.name for field in cloud.fields],
                     "formats": [TYPES[field.datatype] for field in cloud.fields],
                     "offsets": [field.offset for field in cloud.fields], "itemsize": cloud.point_step})
    return np.frombuffer(bytes(cloud.data), kind).reshape(cloud.height, cloud.width)
