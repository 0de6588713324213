// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/playback.hpp>
#include <apps/glidar/run/point_explainer.hpp>
#include <apps/glidar/run/rig_messages.hpp>
#include <glidar/link/foxglove/ros_channels.hpp>
#include <glidar/link/foxglove/server.hpp>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// `--foxglove`: shows the frames in browsers and Foxglove, and explains the points that the user
/// selects. A slow viewer receives the newest frames and delays nothing.
class LiveView final : public FrameSink {
 public:
  /// Listens. `playback` receives the commands of the page; nullptr: there are none. All must
  /// outlive it. Throws Error.
  LiveView(const link::Endpoint& at, Playback* playback, link::ErrorLog& errors);
  ~LiveView() override;
  /// Call when the scene is prepared; flags and scene must outlive it.
  void begin(const RenderFlags& flags, const PreparedScene& prepared, PoseOrigin origin);
  /// The address for a browser on this machine.
  [[nodiscard]] std::string url() const;

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor_index) const override;
  void write(const MeasuredFrame& measured) override;
  /// Shows the state of the playback when it changes.
  void serve() override;
  void finish() override;

 private:
  void explain(const foxglove::Pick& selected, foxglove::PickReply reply);
  void show_playback();

  std::string host_;
  Playback* playback_;
  std::mutex mutex_;  ///< of the explainer, which the server's thread uses
  std::unique_ptr<foxglove::FoxgloveServer> server_;
  std::unique_ptr<foxglove::RosChannels> channels_;
  std::unique_ptr<ros::RigPublisher> publisher_;
  std::unique_ptr<PointExplainer> explainer_;
  std::uint64_t time_ns_ = 0;  ///< of the newest frame
  std::optional<bool> shows_playing_;
};

}  // namespace glidar::app
