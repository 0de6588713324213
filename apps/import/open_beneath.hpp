// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/unique_fd.hpp>

#include <filesystem>

namespace glidar::import {

/// A descriptor of the folder, for open_beneath() only; -1 when it cannot be opened.
UniqueFd open_root(const std::filesystem::path& root);

/// Opens a file below the root for reading, without blocking; `path` is canonical. The kernel
/// resolves it from the root's descriptor and follows neither a link nor a way out of the root
/// (openat2, RESOLVE_BENEATH), so that nobody can exchange a folder between the check of the path
/// and its opening. A kernel without openat2 (before Linux 5.6) opens the path that was checked.
/// -1, with errno, when it cannot be opened.
UniqueFd open_beneath(int root_fd, const std::filesystem::path& root,
                      const std::filesystem::path& path);

}  // namespace glidar::import
