// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <apps/glidar/run/console.hpp>
#include <glidar/io/formats/file_sink.hpp>

#include <string>
#include <vector>

namespace glidar::app {

/// The arguments without those that change nothing in a cloud: --threads, --quiet, and the options
/// of the model cache, which belong to the user who runs the command.
std::vector<std::string> reproducible_arguments(const std::vector<std::string>& arguments);

/// Sets a subcommand's options from the reproducible_arguments() arguments of a file: a file names
/// no cache folder. Throws Error, naming the file, when they are those of another subcommand or not
/// understood.
void parse_recorded(const std::vector<std::string>& arguments, const std::string& subcommand,
                    const std::string& file, CLI::App& command);

/// Warns when the file was written by another version of the program.
void compare_version(const std::string& written_by, const std::string& file, Console& console);

/// Goes to the folder where the command ran, from which its paths count. Throws Error.
void enter_folder(const CommandRecord& command, const std::string& file);

}  // namespace glidar::app
