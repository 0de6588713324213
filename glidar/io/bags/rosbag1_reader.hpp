// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/bags/chunk_merger.hpp>

namespace glidar::bags {

/// Opens a bag of ROS 1, version 2.0, without compression or with LZ4; what it reads counts in the
/// budget. Throws Error when it is damaged, has no index because a program ended before it was
/// complete, or is compressed by bzip2.
std::unique_ptr<BagReader> open_rosbag1(const std::filesystem::path& path, SharedBudget budget);

}  // namespace glidar::bags
