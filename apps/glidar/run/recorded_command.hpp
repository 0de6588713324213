// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <apps/glidar/run/console.hpp>
#include <glidar/io/formats/file_sink.hpp>

#include <string>
#include <vector>

namespace glidar::app {

/// The arguments that affect a cloud: without --threads, --quiet, and the options of the model
/// cache, which belong to the user who runs the command.
std::vector<std::string> reproducible_arguments(const std::vector<std::string>& arguments);

/// Replaces --start-time by a value that repeats the run; an empty one changes nothing.
void set_start_time(const std::string& value, CommandRecord& command);

/// Sets a subcommand's options from the recorded arguments of a file, which must not contain a
/// cache folder. Throws Error with the file's name if they are invalid or of another subcommand.
void parse_recorded(const std::vector<std::string>& arguments, const std::string& subcommand,
                    const std::string& file, CLI::App& command);

/// Warns if another version of the program wrote the file.
void compare_version(const std::string& written_by, const std::string& file, Console& console);

/// Changes to the folder where the command ran, to which its paths are relative. Throws Error.
void enter_folder(const CommandRecord& command, const std::string& file);

}  // namespace glidar::app
