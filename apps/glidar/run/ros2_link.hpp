// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/message_options.hpp>
#include <apps/glidar/run/interrupt.hpp>
#include <apps/glidar/run/pose_source.hpp>
#include <apps/glidar/run/prepared_scene.hpp>
#include <glidar/link/dds/participant.hpp>
#include <glidar/link/error_log.hpp>
#include <glidar/output/output.hpp>

#include <cstddef>
#include <memory>
#include <optional>

namespace glidar::app {

/// When the frames of a source in ROS 2 end.
struct Ros2Schedule {
  FrameSchedule frames;             ///< its rate counts in the time of the poses
  std::optional<double> timeout_s;  ///< for a pose; empty: no limit
};

/// The connection of a stream to ROS 2. It outlives the output and the source that it makes.
class Ros2Link {
 public:
  /// Joins the domain. Flags and log must outlive it. Throws Error.
  Ros2Link(const Ros2Flags& flags, link::ErrorLog& errors);

  /// Publishes frames. `speed`: how fast their time passes; 0: it is not related to real time.
  [[nodiscard]] std::unique_ptr<Output> open(const OutputRig& rig, const OutputOptions& options,
                                             double speed) const;
  /// Subscribes to the poses, or the clock, of the flags. `queue`: poses that wait; 0: the newest
  /// only.
  std::unique_ptr<PoseSource> make_source(const Ros2Schedule& schedule, std::size_t queue,
                                          const PreparedScene& prepared, const StopRequest& stop);

 private:
  const Ros2Flags& flags_;
  dds::Participant participant_;
  std::unique_ptr<dds::PoseSubscriber> poses_;
  std::unique_ptr<dds::ClockSubscriber> clock_;
};

}  // namespace glidar::app
