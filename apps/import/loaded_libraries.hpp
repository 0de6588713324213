// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace glidar::import {

/// Paths of the shared libraries that this process runs with, Assimp's among them.
std::vector<std::string> loaded_libraries();

}  // namespace glidar::import
