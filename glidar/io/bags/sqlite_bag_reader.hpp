// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/bags/bag_storage.hpp>

namespace glidar::bags {

/// Opens one file of the SQLite storage of rosbag2. Throws Error.
std::unique_ptr<BagReader> open_sqlite_bag(const std::filesystem::path& path, SharedBudget budget);

}  // namespace glidar::bags
