// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <climits>
#include <filesystem>
#include <string>
#include <vector>

namespace glidar::import {

/// The newest version of Landlock's interface: whatever the kernel has.
inline constexpr long kNewestLandlock = LONG_MAX;

struct FileRestriction {
  std::string failure;             ///< the reason; empty: files are restricted
  bool covers_truncation = false;  ///< from version 3; older ones let readers truncate files
};

/// Restricts this process to reading these files, and files below these folders. If the kernel
/// supports it, also forbids TCP, abstract UNIX sockets and signals to other processes. Uses no
/// version of the interface above `newest`. Needs PR_SET_NO_NEW_PRIVS.
FileRestriction restrict_files(const std::vector<std::filesystem::path>& readable,
                               long newest = kNewestLandlock);

}  // namespace glidar::import
