// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace glidar::testing {

/// Writes the samples of all messages, with the numbers 0, 1 and 2, to /PointCloud2 and so on for
/// every line of its input, and to a bag with the same topics.
int write_samples(const std::filesystem::path& bag);

/// Prints the poses of a topic as JSON, a line each, until its input ends.
int print_poses(const std::string& topic);

}  // namespace glidar::testing
