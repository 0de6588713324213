// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/dds/pose_decoder.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace glidar::dds {

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
