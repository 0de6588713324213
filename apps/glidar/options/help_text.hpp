// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>

#include <string>
#include <string_view>

namespace glidar::app {

/// The words with two spaces before each line, in lines of at most 100 columns.
std::string indented(std::string_view words);

/// Lays --help of the program and of all its subcommands out; to be called before these are added.
void use_help_layout(CLI::App& program);

}  // namespace glidar::app
