// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace glidar::import {

/// Takes from this process, for good, all that reading a model does not need, so that a model that
/// takes over the importer gains nothing:
///  - every descriptor above `last_fd` is closed;
///  - Landlock (Linux 5.13): no file can be opened but for reading below `root`, no TCP connection
///    be made (Linux 6.7), no process outside be signalled (Linux 6.12);
///  - a seccomp filter: only the system calls that reading files and computing need are left.
///    Without them no process, socket, executable memory, signal to others or change of any file is
///    possible. Others fail with EPERM.
/// Returns a note, in words for the user, for each mechanism that the system does not have. The
/// address and thread sanitizers need what this takes away; there it is one note.
std::vector<std::string> enter_sandbox(const std::filesystem::path& root, int last_fd);

}  // namespace glidar::import
