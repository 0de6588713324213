// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <filesystem>

namespace glidar {

/// Waits until the data of an open file is on the disk. `path` appears in errors. Throws Error;
/// then it is unknown which bytes are on the disk.
void sync_file(int descriptor, const std::filesystem::path& path);

/// Waits until the names in the folder of this file are on the disk. Ignores file systems that
/// cannot sync a folder, such as some network file systems. Throws Error.
void sync_folder_of(const std::filesystem::path& path);

}  // namespace glidar
