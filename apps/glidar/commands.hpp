// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/cli_fwd.hpp>

#include <functional>

namespace glidar::app {

/// Each adds its subcommand to the program and returns what runs it once the options are read; that
/// returns the exit code and throws Error.
using Command = std::function<int()>;

Command add_render(CLI::App& program);
Command add_info(CLI::App& program);
Command add_sensors(CLI::App& program);
Command add_verify(CLI::App& program);

}  // namespace glidar::app
