// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace glidar {

/// Path of the import program `glidar-import`: the environment variable GLIDAR_IMPORT_HELPER, next
/// to the running program, in ../libexec/glidar from there, where it was built, or where it is
/// installed. Throws Error naming these paths when none of them has it.
std::filesystem::path import_program();

}  // namespace glidar
