// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the library: checks paths and arguments in files from an untrusted source.

#include <string>
#include <string_view>

namespace glidar {

/// Throws Error unless a path of a recording or sidecar is valid: not empty, at most 4096 bytes,
/// without control characters or zero bytes (which would end it for the system). `where` is
/// the file, with the line if it has several; `key` the purpose of the path.
void check_recorded_path(const std::string& where, std::string_view key, std::string_view path);

/// The same for an argument of a recorded command, which may be empty and longer.
void check_recorded_argument(const std::string& where, std::string_view argument);

}  // namespace glidar
