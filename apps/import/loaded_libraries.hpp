// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace glidar::import {

/// Paths of the shared libraries of this process, including Assimp's.
std::vector<std::string> loaded_libraries();

}  // namespace glidar::import
