// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>

#include <functional>
#include <string>
#include <vector>

namespace glidar::app {

/// Each adds its subcommand to the program and returns what runs it once the options are read; that
/// returns the exit code and throws Error.
using Command = std::function<int()>;

/// `arguments` are those of the whole command line, for sidecars and recordings.
Command add_render(CLI::App& program, const std::vector<std::string>& arguments);
Command add_campaign(CLI::App& program);
Command add_decode(CLI::App& program);
Command add_explain(CLI::App& program);
Command add_info(CLI::App& program);
Command add_stream(CLI::App& program, const std::vector<std::string>& arguments);
Command add_replay(CLI::App& program);
Command add_sensors(CLI::App& program);
Command add_schema(CLI::App& program);
Command add_depth(CLI::App& program);
Command add_verify(CLI::App& program);
/// Call it last: it prints all subcommands of the program, which must outlive it.
Command add_completion(CLI::App& program);

}  // namespace glidar::app
