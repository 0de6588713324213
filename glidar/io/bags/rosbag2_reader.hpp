// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/bags/bag.hpp>

namespace glidar::bags {

/// Opens a folder with metadata.yaml of any version, whose storage is sqlite3 or mcap without
/// compression of files or messages. Several files are merged by time. Throws Error.
std::unique_ptr<BagReader> open_rosbag2(const std::filesystem::path& path);

/// Throws Error unless the folder has a metadata.yaml that can be read.
void require_metadata(const std::filesystem::path& path);

}  // namespace glidar::bags
