// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/file_sink.hpp>

#include <string>
#include <vector>

namespace glidar {

/// All columns that a format may read: those of FileFormat, and those that it needs for some
/// sensors and scenes (KITTI: the range to calibrate intensities, instance and class for labels).
std::vector<std::string> needed_columns(const FileFormat& format);

}  // namespace glidar
