// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/math/thread_pool.hpp>

#include <span>
#include <string>

namespace glidar {

/// The coordinate frame of a cloud, and the threads that compute it.
struct OutputFrame {
  std::string frame_id;
  Pose cloud_from_sensor = Pose::Identity();  ///< of the sensor at the start of the frame
  bool deskew = false;                ///< correct xyz for the sensor's motion during the frame
  ThreadPool* thread_pool = nullptr;  ///< nullptr: the calling thread alone
};

/// Names that output_frame() accepts: sensor optical ros gl world legacy.
std::span<const std::string> output_frame_names();

/// The coordinate frame of this name for a sensor with these beams and this pose: the sensor frame
/// (`sensor`), x right, y down, z forward (`optical`), x forward, y left, z up (`ros`), x right,
/// y up, z back (`gl`), x left, y up, z forward (`legacy`), or the scene's (`world`).
/// Throws Error for an unknown name.
OutputFrame output_frame(const std::string& name, const Beams& beams,
                         const Pose& world_from_sensor);

}  // namespace glidar
