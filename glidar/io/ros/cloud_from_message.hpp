// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>
#include <glidar/io/ros/messages.hpp>

namespace glidar::ros {

/// The points of a message with any fields, offsets and byte order, in the frame
/// message.header.frame_id. x, y and z become the column `xyz`; other fields become columns of
/// their name, see FileText::column_name(), with a number if that is in use: a_b and a.b become a_b
/// and a_b_2. Signed integers become int64. Throws Error when sizes contradict each other,
/// fields overlap or repeat, or x, y or z are missing or no floats.
PointCloud to_point_cloud(const PointCloud2& message);

/// The same for a CustomMsg: columns xyz, reflectivity, tag, line and offset_time, ns since
/// timebase.
PointCloud to_point_cloud(const CustomMsg& message);

}  // namespace glidar::ros
