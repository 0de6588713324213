// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/ros.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace glidar::ros {

/// When the next frames of a rig can begin. Its frames arrive in the order of their start.
class FrameArrivals {
 public:
  /// `is_periodic`: every frame begins where the last one of its sensor ends. Otherwise each pose
  /// gives one frame of every sensor, at times that are not known before.
  FrameArrivals(std::size_t sensors, bool is_periodic)
      : sensors_(sensors), is_periodic_(is_periodic) {}

  /// A frame that began at `start_ns`. Its sensor measures for `duration_ns`. False if it is
  /// earlier than the last frame, as after a step back in a recording.
  bool add(std::size_t sensor, std::int64_t start_ns, std::int64_t duration_ns);

  /// No frame that arrives later begins before this time.
  [[nodiscard]] std::int64_t complete_ns() const;
  /// The first end of the frames that are expected next; empty before the first frame.
  [[nodiscard]] std::optional<std::int64_t> next_end_ns() const;

 private:
  struct SensorFrames {
    std::optional<std::int64_t> start_ns = {};  ///< of its last frame
    std::int64_t next_start_ns = 0;
    std::int64_t next_end_ns = 0;
  };

  std::vector<SensorFrames> sensors_;
  bool is_periodic_;
  std::optional<std::int64_t> last_start_ns_;
};

}  // namespace glidar::ros
