// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace glidar::import {

/// Leaves this process no access to files but reading below `root`, and, as far as the kernel
/// knows, no TCP, no abstract UNIX sockets and no signals to other processes.
/// Returns why not, in words, or "". Needs PR_SET_NO_NEW_PRIVS.
std::string restrict_files(const std::filesystem::path& root);

}  // namespace glidar::import
