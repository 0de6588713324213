// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/commands/commands.hpp>

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace glidar::app {

/// A subcommand and what adds it to the program.
struct Subcommand {
  std::string name;
  /// Gets the program and the arguments of the whole command line.
  std::function<Command(CLI::App& program, const std::vector<std::string>& arguments)> add;
};

/// Parses the command line and runs the chosen subcommand; returns the exit code. `has_viewer`:
/// --version lists the window.
int run_program(std::span<const Subcommand> subcommands, bool has_viewer, int argc, char** argv);

/// Prints the message as an error; returns the exit code of invalid input.
int report_error(const std::string& message);

}  // namespace glidar::app
