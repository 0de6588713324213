// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/io/ros/messages.hpp>

#include <string>

namespace glidar::ros {

/// The boxes of a frame's objects as cubes that viewers draw, in the sensor's frame. The name space
/// of a cube is the object's class, its number the object's id, and its text all that is known of
/// the box, as JSON. Throws Error for a time that ROS cannot represent.
MarkerArray box_markers(const Scene& scene, const Frame& frame, const std::string& frame_id);

}  // namespace glidar::ros
