// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/recorded_command.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/version.hpp>
#include <glidar/io/files/content_hash.hpp>
#include <glidar/io/formats/sidecar.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <system_error>

namespace glidar::app {

namespace {

using Names = std::initializer_list<std::string_view>;

/// The arguments except these options, with and without values.
std::vector<std::string> without(const std::vector<std::string>& arguments, Names flags,
                                 Names with_value) {
  const auto has = [](Names options, std::string_view name) {
    return std::find(options.begin(), options.end(), name) != options.end();
  };
  std::vector<std::string> kept;
  bool is_value = false;
  for (const std::string& argument : arguments) {
    const std::string_view name = std::string_view(argument).substr(0, argument.find('='));
    const bool is_option = !is_value && (has(flags, name) || has(with_value, name));
    if (!is_option && !is_value) kept.push_back(argument);
    is_value = is_option && has(with_value, argument);
  }
  return kept;
}

}  // namespace

std::vector<std::string> reproducible_arguments(const std::vector<std::string>& arguments) {
  return without(arguments, {"-q", "--quiet", "--no-cache"}, {"-j", "--threads", "--cache-folder"});
}

void set_start_time(const std::string& value, CommandRecord& command) {
  if (value.empty()) return;
  command.arguments = without(command.arguments, {}, {"--start-time"});
  command.arguments.insert(command.arguments.end(), {"--start-time", value});
}

void parse_recorded(const std::vector<std::string>& arguments, const std::string& subcommand,
                    const std::string& file, CLI::App& command) {
  const auto refuse = [&](const char* found) {
    throw Error({file, found, "what `glidar " + subcommand + "` wrote", "write it again"});
  };
  const std::vector<std::string> kept = reproducible_arguments(arguments);
  if (kept.empty() || kept.front() != subcommand)
    refuse(kept.empty() ? "it has no command, because a simulator or a recording gave the poses"
                        : "it has another command");
  try {
    command.parse(std::vector<std::string>(kept.rbegin(), kept.rend() - 1));
  } catch (const CLI::ParseError&) {
    refuse("its command is not valid");
  }
  const CLI::Option* folder = command.get_option_no_throw("--cache-folder");
  if (folder != nullptr && folder->count() > 0)
    refuse("its command has a folder for the model cache");
}

void compare_version(const std::string& written_by, const std::string& file, Console& console) {
  if (written_by == version()) return;
  console.warn(fmt::format("{} was written by glidar {}, this is {}", file, written_by, version()));
}

void enter_folder(const CommandRecord& command, const std::string& file) {
  std::error_code problem;
  std::filesystem::current_path(command.folder, problem);
  if (!problem) return;
  throw Error({file,
               fmt::format("its command ran in {}: {}", command.folder.lexically_normal().string(),
                           problem.message()),
               "the same path from the file to that folder as before", "move the files back"});
}

void Recorder::begin(const PreparedScene& prepared, const CommandRecord& command) {
  link::RecordingHead head{.version = version(), .command = command, .files = {}};
  for (const std::string& file : prepared.files) {
    const std::optional<Hash128> hash = hash_file(file);
    head.files.push_back({.path = file, .hash = hash ? hex(*hash) : ""});
  }
  writer_.begin(head);
}

link::RecordedFrame line_of(std::size_t sensor_index, const Frame& frame,
                            const lockstep::Moment* placed) {
  link::RecordedFrame line{.sensor = static_cast<std::uint32_t>(sensor_index),
                           .moment = placed != nullptr ? *placed : lockstep::Moment{},
                           .is_placed = placed != nullptr,
                           .frame_hash = frame_hash(frame)};
  line.moment.t_ns = frame.stamp_ns;
  line.moment.seed = frame.seed;
  line.moment.number = frame.number;
  return line;
}

}  // namespace glidar::app
