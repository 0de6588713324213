// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/interrupt.hpp>
#include <apps/glidar/run/prepared_scene.hpp>
#include <glidar/io/ros/rig_publisher.hpp>
#include <glidar/link/foxglove/protocol.hpp>
#include <glidar/link/foxglove/ros_channels.hpp>
#include <glidar/link/foxglove/server.hpp>
#include <glidar/output/output.hpp>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace glidar::app {

/// A point of a published cloud.
struct PublishedPoint {
  std::string topic;
  std::int64_t stamp_ns = 0;  ///< of the message's header
  std::uint64_t index = 0;    ///< in the message
};

/// Explains points of recent frames in a thread of its own and with a renderer of its own, so that
/// measuring is not interrupted. The renderer is prepared for the first point. Thread-safe.
class PointExplainer {
 public:
  /// Receives the explanation, or why there is none.
  using Reply = std::function<void(const std::string& text)>;

  /// All must outlive it.
  PointExplainer(const RenderFlags& flags, const PreparedScene& prepared,
                 const ros::RigPublisher& publisher);
  /// Ends the explanation that is being computed; points without a reply get none.
  ~PointExplainer();
  PointExplainer(const PointExplainer&) = delete;
  PointExplainer& operator=(const PointExplainer&) = delete;

  /// Remembers how a frame was measured; old ones are forgotten.
  void add_frame(const RigFrame& measured);
  void explain(PublishedPoint point, Reply reply);

 private:
  /// What a measurement depends on.
  struct KnownFrame {
    std::size_t sensor_index = 0;
    std::int64_t message_ns = 0;  ///< stamp of its messages
    std::int64_t stamp_ns = 0;
    std::uint32_t number = 0;
    std::uint64_t seed = 0;
    std::shared_ptr<const Motion> motion;
  };
  struct Question {
    PublishedPoint point;
    Reply reply;
  };

  void run();
  [[nodiscard]] KnownFrame find_frame(const PublishedPoint& point) const;
  [[nodiscard]] std::string explanation(const PublishedPoint& point);
  [[nodiscard]] std::size_t entry_of(const PublishedPoint& point, std::size_t sensor_index,
                                     const Frame& frame, const Beams& beams) const;
  Simulator& simulator_of(std::size_t sensor_index);

  const RenderFlags& flags_;
  const PreparedScene& prepared_;
  const ros::RigPublisher& publisher_;
  // used by the thread only
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<Woods2016Camera> woods2016_camera_;
  std::vector<std::shared_ptr<Simulator>> simulators_;  ///< of each sensor; nullptr: not yet made

  mutable std::mutex mutex_;  ///< of what follows
  std::condition_variable changed_;
  std::deque<KnownFrame> frames_;  ///< the newest last
  std::deque<Question> questions_;
  std::atomic<bool> is_ending_ = false;
  std::thread thread_;
};

/// Whether the frames of a replay follow by themselves, as the user of the live view decides.
/// Begins paused at the first frame. Thread-safe.
class Playback {
 public:
  /// Of the page; from any thread.
  void command(foxglove::PlaybackCommand command);
  /// Waits until the next frame is due by these commands. False: a stop was requested before.
  bool wait(const StopRequest& stop);
  [[nodiscard]] bool is_playing() const;

 private:
  bool take_step();

  mutable std::mutex mutex_;
  bool is_playing_ = false;
  std::uint64_t steps_ = 1;  ///< frames that are due while it is paused
};

/// `--foxglove`: shows the frames in browsers and Foxglove, and explains the points that the user
/// selects. A slow viewer receives the newest frames and delays nothing.
class LiveView final : public Output {
 public:
  /// Listens. `playback` receives the commands of the page; nullptr: there are none. All must
  /// outlive it. Throws Error.
  LiveView(const link::Endpoint& at, Playback* playback, link::ErrorLog& errors);
  ~LiveView() override;
  /// Call when the scene is prepared; flags and scene must outlive it. `rig` is that of the scene.
  void begin(const RenderFlags& flags, const PreparedScene& prepared, const OutputRig& rig);
  /// The address for a browser on this machine.
  [[nodiscard]] std::string url() const;

  [[nodiscard]] HitColumnMask hit_columns(std::size_t sensor) const override;
  void write(const RigFrame& written) override;
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
