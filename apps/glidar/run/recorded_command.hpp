// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/prepared_scene.hpp>
#include <glidar/io/formats/file_sink.hpp>
#include <glidar/link/recording.hpp>

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

/// `--record`: keeps the inputs of every frame of a stream and a hash of its result.
class Recorder {
 public:
  /// Throws Error if the file cannot be created.
  Recorder(const std::string& path, bool is_durable)
      : writer_(path),
        durability_(is_durable ? link::Durability::synced : link::Durability::none) {}
  /// Call when the scene is prepared.
  void begin(const PreparedScene& prepared, const CommandRecord& command);
  void write(const link::RecordedFrame& frame) { writer_.write(frame); }
  void commit() { writer_.commit(durability_); }

 private:
  link::RecordingWriter writer_;
  link::Durability durability_;
};

/// The record of a frame of one sensor. `placed`: poses by a client or simulator;
/// nullptr: by the command.
link::RecordedFrame line_of(std::size_t sensor_index, const Frame& frame,
                            const lockstep::Moment* placed);

}  // namespace glidar::app
