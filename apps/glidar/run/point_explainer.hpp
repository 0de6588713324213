// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/measured_frame.hpp>
#include <apps/glidar/run/prepared_scene.hpp>
#include <glidar/io/ros/rig_publisher.hpp>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
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
  void add_frame(const MeasuredFrame& measured);
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

}  // namespace glidar::app
