// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/landlock.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace glidar::import {

/// Permanently removes all rights that reading a model does not need, so that a hostile model that
/// takes over the importer gains nothing:
///  - every descriptor above `last_fd` is closed;
///  - Landlock (Linux 5.13): only `readable` files, and files below such folders, can be opened,
///    and only for reading; no TCP connections (Linux 6.7), no signals to other processes (Linux
///    6.12);
///  - a seccomp filter: only the system calls for reading files and computing are allowed, so that
///    no process, socket, executable memory, signal to others or change of a file is possible.
///    Others fail with EPERM.
/// `newest_landlock` limits the version of Landlock, for tests of old kernels.
/// Returns a note for the user for each mechanism that the system lacks. Builds with the address or
/// thread sanitizer have no sandbox and return one note.
std::vector<std::string> enter_sandbox(const std::vector<std::filesystem::path>& readable,
                                       int last_fd, long newest_landlock = kNewestLandlock);

}  // namespace glidar::import
