// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace glidar::app {

/// The text with its spaces made line ends so that it fits beside the option names of --help.
std::string wrapped(std::string_view text);

}  // namespace glidar::app
