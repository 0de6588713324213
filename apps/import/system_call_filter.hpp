// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace glidar::import {

/// openat2 passes its flags in memory, where a filter cannot see whether it opens for writing: it
/// is safe only where Landlock forbids that.
enum class Openat2 : std::uint8_t { allowed, refused };

/// Leaves this process only the system calls that reading files and computing need (libseccomp).
/// All others fail with EPERM. Returns why not, in words, or "". Needs PR_SET_NO_NEW_PRIVS.
std::string filter_system_calls(Openat2 openat2);

}  // namespace glidar::import
