// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace glidar::app {

/// The embedded text of a file of shaders/; throws std::out_of_range for an unknown name.
std::string_view shader_text(std::string_view file);

}  // namespace glidar::app
