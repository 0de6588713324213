// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace glidar::app {

/// The text of a file of shaders/, built into the program; throws std::out_of_range for another.
std::string_view shader_text(std::string_view file);

}  // namespace glidar::app
