// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <filesystem>

namespace glidar {

/// Waits until the data of an open file is on the disk. `path` appears in errors. Throws Error:
/// after it, nobody knows which bytes are on the disk.
void sync_file(int descriptor, const std::filesystem::path& path);

/// Waits until the names in the folder of this file are on the disk. File systems that cannot sync
/// a folder, such as some of networks, are left to their own promises. Throws Error.
void sync_folder_of(const std::filesystem::path& path);

}  // namespace glidar
