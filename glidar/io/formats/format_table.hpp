// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: the table of file formats.

#include <glidar/io/formats/format.hpp>

#include <filesystem>
#include <vector>

namespace glidar {

/// All formats, in the order in which they are listed to users.
const std::vector<Format>& formats();

/// The format with the longest suffix that matches the name; trailing separators of
/// the path are ignored.
/// Throws Error naming all formats and the nearest one.
const Format& find_format(const std::filesystem::path& given);

}  // namespace glidar
