// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace glidar::import {

/// Restricts this process to reading the file `root`, or files below that folder. If the kernel
/// supports it, also forbids TCP, abstract UNIX sockets and signals to other processes. Returns the
/// reason for a failure, or
/// "". Needs PR_SET_NO_NEW_PRIVS.
std::string restrict_files(const std::filesystem::path& root);

}  // namespace glidar::import
