// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>
#include <glidar/io/bags/bag.hpp>

#include <string>

namespace glidar::bags {

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

}  // namespace glidar::bags
