// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/unique_fd.hpp>

#include <filesystem>

namespace glidar::import {

/// A descriptor of the folder, for open_beneath() only; -1 on failure.
UniqueFd open_root(const std::filesystem::path& root);

/// Opens a file below the root for reading, without blocking; `path` is canonical. The kernel
/// resolves it from the root's descriptor and follows no links and no path out of the root
/// (openat2, RESOLVE_BENEATH), so that no folder can be exchanged between the check of the path and
/// its opening. A kernel without openat2 (before Linux 5.6) opens the checked path. -1, with errno,
/// on failure.
UniqueFd open_beneath(int root_fd, const std::filesystem::path& root,
                      const std::filesystem::path& path);

}  // namespace glidar::import
