// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/delivery.hpp>
#include <apps/glidar/run/interrupt.hpp>
#include <apps/glidar/run/live_view.hpp>
#include <apps/glidar/run/pose_source.hpp>
#include <apps/glidar/run/prepared_scene.hpp>
#include <apps/glidar/run/recorded_command.hpp>
#include <apps/glidar/run/ros2_link.hpp>
#include <apps/glidar/run/stream_report.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/link/error_log.hpp>
#include <glidar/link/recording.hpp>
#include <glidar/output/output.hpp>
#include <glidar/woods2016/protocol.hpp>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace glidar::app {

/// `glidar stream`: source of poses -> simulate -> outputs.
class StreamRun {
 public:
  /// Listens at its ports, then loads the inputs of the flags. Throws Error.
  StreamRun(StreamFlags flags, Console& console);
  /// Runs the stream and returns the exit code. Notifies subscribers and writes the statistics in
  /// any case, also when it throws.
  int run();

 private:
  void open_scene();
  void open_outputs(const OutputRig& rig);
  [[nodiscard]] std::map<std::uint32_t, std::string> topics() const;
  void prepare_poses();
  [[nodiscard]] std::unique_ptr<PoseSource> make_source(const StopRequest& stop);
  [[nodiscard]] bool has_all_peers(const StopRequest& stop);
  void stream(PoseSource& source, StopRequest& stop);
  void measure(const FrameRequest& request, MeasuredFrame& measured);
  [[nodiscard]] bool is_wanted(std::uint64_t index) const;
  [[nodiscard]] bool move(const RigMotion& motion);
  void deliver(const MeasuredFrame& measured);
  void publish(const MeasuredFrame& measured);
  void serve_peers();
  void finish(const std::string& ending, bool is_urgent = false);

  StreamFlags flags_;
  Console& console_;
  link::ErrorLog errors_;
  std::unique_ptr<AtomicFile> stats_file_;
  link::Context context_;
  std::unique_ptr<woods2016::CloudPublisher> publisher_;
  std::unique_ptr<woods2016::PoseReceiver> receiver_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<link::RecordingReader> recording_;  ///< recording to repeat
  std::shared_ptr<const lockstep::Moment> placed_;    ///< poses of the simulator's last message
  double duration_s_ = 0.0;
  PreparedScene prepared_;
  std::vector<std::shared_ptr<const Motion>> motions_;  ///< of each sensor, now
  bool is_within_reach_ = true;                         ///< all sensors and instances, now
  std::unique_ptr<Playback> playback_;                  ///< of a replay with a live view
  std::unique_ptr<LiveView> live_view_;                 ///< until it is one of the outputs
  std::unique_ptr<Ros2Link> ros2_;
  std::vector<std::unique_ptr<Output>> outputs_;
  MovedScene moved_scene_;
  HitColumnMask hit_columns_;
  StreamStats stats_;
  StreamStats::Clock::time_point status_time_;
  PointCloud cloud_;
  std::uint64_t measured_ = 0;
  std::uint64_t late_ = 0;
  int exit_code_ = kDone;
  std::string ending_;  ///< of the wait for partners; empty: the source of poses gives it
  bool is_finished_ = false;
};

}  // namespace glidar::app
