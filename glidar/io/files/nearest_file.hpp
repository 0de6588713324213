// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace glidar {

/// The name in the folder of a path that is most like the path's own; empty when none is near.
/// For "did you mean" where there is no such file.
std::string nearest_file(const std::filesystem::path& path);

}  // namespace glidar
