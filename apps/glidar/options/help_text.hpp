// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace glidar::app {

/// The heading of options that the original GLIDAR of 2015 has.
inline constexpr const char* kWoods2016Heading = "Woods 2016 compatibility";

/// The words in lines of at most 100 columns, each after two spaces.
std::string indented(std::string_view words);

/// The help of the options of a command under headings that contain the words; empty: none.
std::string section_help(const CLI::App& command, const std::string& words);

/// The names of the subcommands, in the order in which they were added.
std::vector<std::string> subcommand_names(const CLI::App& command);

/// The command with those it belongs to: "glidar depth stereo".
std::string full_name(const CLI::App& command);

/// Sets the layout of --help for the program and the subcommands that are added later.
void use_help_layout(CLI::App& program);

}  // namespace glidar::app
