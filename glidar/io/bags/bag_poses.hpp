// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/bags/bag.hpp>
#include <glidar/motion/timed_poses.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace glidar::bags {

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
