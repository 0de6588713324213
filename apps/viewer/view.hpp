// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/commands/commands.hpp>

namespace glidar::app {

/// Adds `glidar view`, see commands.hpp.
Command add_view(CLI::App& program);

/// Whether this build has the window.
bool has_viewer();

}  // namespace glidar::app
