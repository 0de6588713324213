// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/codec.hpp>
#include <glidar/io/ros/pose_message.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar::dds {

/// Maximum length of the name of a coordinate frame.
inline constexpr std::size_t kMaxFrameName_bytes = 255;
/// Maximum number of transforms in a message.
inline constexpr std::size_t kMaxTransforms = 10'000;

/// A pose as a message gives it.
struct FramedPose {
  ros::FramePair frames;  ///< child in parent; a PoseStamped has no child
  TimedPose pose;         ///< valid, with a normalised quaternion
};

/// The poses of a TFMessage, Odometry or PoseStamped, serialized as CDR. Throws Error unless it is
/// one message of this type, with frames that have names of a limited length, stamps within a
/// second, finite coordinates of at most 1e15 m and quaternions whose length is 1 within 0.001.
std::vector<FramedPose> decode_poses(const ros::MessageType& type,
                                     std::span<const std::byte> message);

/// The time of a Clock, ns. Throws Error unless it is one.
std::int64_t decode_clock(std::span<const std::byte> message);

/// The newest transform of each coordinate frame, as ROS publishes them: every frame has one
/// parent.
class TransformTree {
 public:
  static constexpr std::size_t kMaxFrames = 10'000;

  /// Replaces the transform of the frame `pose.frames.child`. False, without an effect, when the
  /// tree is full or the frame is its own parent.
  bool set(const FramedPose& pose, bool is_static);

  /// The pose of `child` in `parent` by the newest transforms; its time is that of the newest
  /// transform that is not static, or 0. Empty: they are not connected.
  [[nodiscard]] std::optional<TimedPose> find(const std::string& parent,
                                              const std::string& child) const;

 private:
  struct Edge {
    std::string parent;
    Pose parent_from_child;
    std::optional<std::int64_t> t_ns;  ///< empty: static
  };
  /// A frame on the way to the root, and the pose of the first frame in it.
  struct Step {
    std::string frame;
    Pose frame_from_first = Pose::Identity();
    std::optional<std::int64_t> newest_ns;  ///< of the transforms up to it
  };
  [[nodiscard]] std::vector<Step> way_to_root(const std::string& first) const;

  std::map<std::string, Edge> edges_;  ///< by child
};

}  // namespace glidar::dds
