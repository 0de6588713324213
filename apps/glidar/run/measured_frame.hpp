// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/link/lockstep/messages.hpp>
#include <glidar/motion/motion.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace glidar::app {

/// A frame to be delivered.
struct MeasuredFrame {
  Frame frame;
  std::shared_ptr<const Beams> beams;
  std::uint64_t index = 0;                         ///< among its sensor's frames
  std::size_t sensor_index = 0;                    ///< of its sensor among those of the scene
  std::shared_ptr<const Motion> motion;            ///< with which it was measured
  std::shared_ptr<const lockstep::Moment> placed;  ///< poses by a client; nullptr: by the command
  std::string frame_hash;                          ///< expected frame_hash(); empty: unknown
  std::chrono::steady_clock::time_point due;       ///< when its pose was known
};

}  // namespace glidar::app
