// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>
#include <glidar/io/bags/bag.hpp>
#include <glidar/motion/timed_poses.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar::bags {

/// The type of a topic's messages; nullptr if it is none that GLIDAR knows.
const ros::MessageType* type_of(const StoredTopic& topic);

/// The index of the topic of this name, whose type must be one of `types`. With an empty name, the
/// first topic of the first of the types that the bag has. Throws Error listing the topics that
/// fit.
std::size_t find_topic(const BagReader& bag, const std::string& name,
                       std::span<const ros::MessageType* const> types,
                       const std::filesystem::path& path);

/// A cloud of a bag.
struct BagCloud {
  std::int64_t stamp_ns = 0;  ///< of its header
  std::int64_t time_ns = 0;   ///< at which the message was recorded
  PointCloud cloud;           ///< see ros::to_point_cloud(); world_from_cloud is the identity
};

/// Reads the clouds of one topic of PointCloud2 or CustomMsg, in order of time.
class BagClouds {
 public:
  /// `topic` empty: the first one. Throws Error as open_bag() does, and when there is no such
  /// topic.
  explicit BagClouds(const std::filesystem::path& path, const std::string& topic = {})
      : BagClouds(open_bag(path), path, topic) {}
  /// `path` names the bag in errors.
  BagClouds(std::unique_ptr<BagReader> bag, const std::filesystem::path& path,
            const std::string& topic);

  [[nodiscard]] const StoredTopic& topic() const { return topic_; }
  /// False at the end. Throws Error when a message is damaged.
  bool next(BagCloud& cloud);

 private:
  std::unique_ptr<BagReader> bag_;
  StoredTopic topic_;
  bool is_custom_ = false;
};

/// Which poses of a bag are read.
struct PoseSelection {
  std::string topic = {};  ///< empty: /tf or another topic of transforms, else of odometry or poses
  std::string parent_frame = {};  ///< empty: any
  std::string child_frame = {};   ///< empty: any; PoseStamped has none
};

/// The poses of one pair of coordinate frames by their stamps, which increase: messages that repeat
/// a stamp are omitted. TFMessage, Odometry and PoseStamped are read. Without names of frames, the
/// first pair of which there is more than one pose; a transform from child to parent is inverted.
/// Throws Error when there is no such topic or pair, or a message is damaged.
std::vector<TimedPose> read_bag_poses(const std::filesystem::path& path,
                                      const PoseSelection& selection = {});
/// `path` names the bag in errors.
std::vector<TimedPose> read_bag_poses(BagReader& bag, const std::filesystem::path& path,
                                      const PoseSelection& selection);

}  // namespace glidar::bags
