// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace glidar::import {

/// openat2 passes its flags in memory, where a filter cannot check them for writing: it is safe
/// only if Landlock forbids writing.
enum class Openat2 : std::uint8_t { allowed, refused };

/// Allows this process only the system calls for reading files and computing (libseccomp). All
/// others fail with EPERM. Returns the reason for a failure, or "". Needs PR_SET_NO_NEW_PRIVS.
std::string filter_system_calls(Openat2 openat2);

}  // namespace glidar::import
