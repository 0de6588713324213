// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/recorded_command.hpp>
#include <apps/glidar/run/stream_run.hpp>
#include <glidar/io/files/content_hash.hpp>
#include <glidar/link/connection_guard.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <utility>

namespace glidar::app {
namespace {

constexpr const char* kReplayExamples =
    R"(Repeats every frame of a recording and compares it with the recorded frame; the first difference is
an error. Writes files (-o) or publishes (--port, --foxglove) like `glidar stream`. With --foxglove,
the viewer plays, pauses and steps; the replay begins paused and ends by Ctrl-C.
Examples:
  glidar stream builtin:asteroid --object-rate 0,0.5,0 --frames 20 --record r.jsonl -o scan.pcd
  glidar replay r.jsonl
  glidar replay r.jsonl -o again.pcd
  glidar replay r.jsonl -o run.mcap
  glidar replay r.jsonl --port 5555 --rate 10
  glidar replay r.jsonl --foxglove
Models, scene and sensor files must have the same paths relative to the recording.
Exit codes: 0 every frame is the same, 2 bad input or a frame that differs, 130 after Ctrl-C.)";

/// The options of the stream that was recorded.
StreamFlags flags_of(const link::RecordingHead& head, const std::string& file) {
  CLI::App command;
  StreamFlags flags;
  add_stream_options(command, flags);
  parse_recorded(head.command.arguments, "stream", file, command);
  return flags;
}

/// The stream that was recorded, with the options of `replay`.
StreamFlags replayed(StreamFlags recorded, const StreamFlags& chosen) {
  StreamFlags flags = chosen;
  flags.pose_source = recorded.pose_source;
  flags.replays_requests = !recorded.lockstep.empty() || !recorded.ros2.pose_topic.empty();
  flags.render = std::move(recorded.render);
  flags.render.output = chosen.render.output;
  flags.render.renderer.threads = chosen.render.renderer.threads;
  flags.render.quiet = chosen.render.quiet;
  flags.render.duration_s.reset();
  flags.render.motion.to.reset();
  flags.render.motion.stamp_origin =
      has_pose_source(recorded) || flags.replays_requests ? StampOrigin::source : StampOrigin::zero;
  return flags;
}

/// Warns of input files that have changed: frames may differ.
void compare_files(const link::RecordingHead& head, Console& console) {
  for (const link::RecordedFile& file : head.files) {
    const std::optional<Hash128> hash = hash_file(file.path);
    if (file.hash == (hash ? hex(*hash) : "")) continue;
    console.warn(fmt::format("{} has changed since it was recorded", file.path));
  }
}

/// Paths of this command are relative to this folder, those of the recorded one to its own.
void make_absolute(StreamFlags& flags) {
  const auto absolute = [](std::string& path) {
    if (!path.empty()) path = std::filesystem::absolute(path).string();
  };
  absolute(flags.replay);
  absolute(flags.stats);
  absolute(flags.render.output.legacy_name);
  for (std::string& path : flags.render.output.recording_paths) absolute(path);
  for (std::string& path : flags.render.output.imu_paths) absolute(path);
  for (std::string& path : flags.render.output.paths) {
    if (path != kStandardOutput) absolute(path);
  }
}

int run_replay(const StreamFlags& chosen) {
  const std::string file = chosen.replay;
  const link::RecordingReader recording(file);
  StreamFlags flags = replayed(flags_of(recording.head(), file), chosen);
  Console console(flags.render.quiet);
  compare_version(recording.head().version, file, console);
  make_absolute(flags);
  enter_folder(recording.head().command, file);
  compare_files(recording.head(), console);
  link::raise_descriptor_limit(2 * flags.limits.connections);
  StreamRun stream(std::move(flags), console);
  return stream.run();
}

}  // namespace

Command add_replay(CLI::App& program) {
  CLI::App& command = *program.add_subcommand("replay", "Repeat a recorded stream");
  const auto flags = std::make_shared<StreamFlags>();
  command.footer(kReplayExamples);
  command.add_option("RECORDING", flags->replay, "File written by glidar stream --record")
      ->required()
      ->type_name("");
  add_replay_options(command, *flags);
  return [flags, &command] {
    check_ros2_options(command, flags->ros2);
    return run_replay(*flags);
  };
}

}  // namespace glidar::app
