// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <cstdint>
#include <filesystem>
#include <string>

namespace glidar {

/// All bytes of a regular file. Throws Error when it is missing, something else, larger than `most`
/// or cannot be read.
std::string read_whole(const std::filesystem::path& path, std::uintmax_t most);

}  // namespace glidar
