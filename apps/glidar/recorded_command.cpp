// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/recorded_command.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/version.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <system_error>
#include <utility>

namespace glidar::app {

std::vector<std::string> lasting(const std::vector<std::string>& arguments) {
  std::vector<std::string> kept;
  bool is_skipped = false;
  for (const std::string& argument : arguments) {
    const bool is_value = std::exchange(is_skipped, argument == "--threads");
    if (is_value || is_skipped || argument == "--quiet" || argument.starts_with("--threads=")) {
      continue;
    }
    kept.push_back(argument);
  }
  return kept;
}

void parse_recorded(const std::vector<std::string>& arguments, const std::string& subcommand,
                    const std::string& file, CLI::App& command) {
  const auto refuse = [&](const char* found) {
    throw Error({file, found, "what `glidar " + subcommand + "` wrote", "write it again"});
  };
  if (arguments.empty() || arguments.front() != subcommand)
    refuse(arguments.empty() ? "it tells no command: a simulator or a recording gave the poses"
                             : "it tells another command");
  try {
    command.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend() - 1));
  } catch (const CLI::ParseError&) {
    refuse("its command is not understood");
  }
}

void compare_version(const std::string& written_by, const std::string& file, Console& console) {
  if (written_by == version()) return;
  console.warn(fmt::format("{} was written by glidar {}, this is {}", file, written_by, version()));
}

void enter(const CommandRecord& command, const std::string& file) {
  std::error_code problem;
  std::filesystem::current_path(command.folder, problem);
  if (!problem) return;
  throw Error({file,
               fmt::format("its command ran in {}: {}", command.folder.lexically_normal().string(),
                           problem.message()),
               "the way from the file to that folder as it was then", "move the files back"});
}

}  // namespace glidar::app
