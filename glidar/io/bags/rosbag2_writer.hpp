// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/bags/bag.hpp>

namespace glidar::bags {

/// A folder NAME.rosbag2 with metadata.yaml of version 8 and NAME_0.db3 (ros2/rosbag2,
/// rosbag2_storage_sqlite3, schema version 4) or NAME_0.mcap. Throws Error as create_bag() does,
/// and for compression with SQLite.
std::unique_ptr<BagWriter> create_rosbag2(const std::filesystem::path& path,
                                          const BagOptions& options);

}  // namespace glidar::bags
