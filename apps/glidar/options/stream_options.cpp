// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/stream_options.hpp>

#include <apps/glidar/options/numbers.hpp>
#include <apps/glidar/options/option_kinds.hpp>
#include <glidar/core/error.hpp>

#include <CLI/CLI.hpp>

#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace glidar::app {
namespace {

constexpr WholeRange kPorts = {1, 65534};  // and the next one for handshakes
constexpr std::int64_t kMaxQueued = 1'000'000;
constexpr double kLongest_s = 3.2e9;  // a century

[[noreturn]] void refuse_stream(std::string where, std::string found, std::string remedy) {
  throw Error({std::move(where), std::move(found), "", std::move(remedy)});
}

/// Gives an option of `render` another meaning: what it was is taken away.
void remove(CLI::App& command, const char* name) {
  command.remove_option(command.get_option(name));
}

void add_pace_flags(CLI::App& command, StreamFlags& flags) {
  for (const char* name : {"--fisher", "--range-sigma", "--rate", "--duration"}) {
    remove(command, name);
  }
  const std::string group = "Pace and end";
  add_option(command,
             {"--rate", "HZ", "Frames per second; 0 or max: as fast as it goes [sensor's]", group},
             [&flags](std::string_view option, const std::string& text) {
               flags.is_unpaced = text == "max" || parse_number(option, text) == 0.0;
               flags.render.sensor.rate_hz.reset();
               if (!flags.is_unpaced) flags.render.sensor.rate_hz = parse_number(option, text);
             });
  add_number(command, {"--duration", "S", "Ends after S seconds [none]", group},
             flags.render.duration_s);
  add_whole(command, {"--frames", "N", "Ends after N frames [none]", group},
            {1, std::numeric_limits<std::uint32_t>::max()},
            [&flags](std::int64_t n) { flags.frames = static_cast<std::uint64_t>(n); });
  add_text(command, {"--stats", "FILE", "Writes counts and latencies as JSON at the end", group},
           flags.stats);
  add_text(command, {"--record", "FILE", "Keeps poses, seeds and command for glidar replay", group},
           flags.record);
  command
      .add_flag_callback(
          "--durable", [&flags] { flags.durability = link::Durability::synced; },
          "Syncs the finished --record file to the disk [off]")
      ->group(group);
}

void add_publishing_flags(CLI::App& command, StreamFlags& flags) {
  const std::string group = "Clouds over ZeroMQ, as in 2015 (handshakes at the next port)";
  add_whole(command, {"-p,--port", "P", "Port that publishes the clouds", group}, kPorts,
            [&flags](std::int64_t n) { flags.port = static_cast<std::uint16_t>(n); });
  add_text(command, {"--bind", "ADDRESS", "Address to listen at, * for all [127.0.0.1]", group},
           flags.bind);
  add_whole(command,
            {"--subscribers", "N", "Waits for N that shake hands and subscribe [1]", group},
            {0, kMaxQueued},
            [&flags](std::int64_t n) { flags.subscribers = static_cast<std::uint64_t>(n); });
  add_option(
      command,
      {"--subscription-timeout", "S", "Waits S seconds for subscriptions to follow [10]", group},
      [&flags](std::string_view option, const std::string& text) {
        flags.subscription_timeout_s = parse_number(option, text);
        require(flags.subscription_timeout_s >= 0.0 && flags.subscription_timeout_s <= kLongest_s,
                option, flags.subscription_timeout_s, "seconds from 0 up to 3.2e9");
      });
  add_whole(command, {"--publish-every", "K", "Publishes every K-th frame [1; in 2015: 15]", group},
            {1, kMaxQueued},
            [&flags](std::int64_t n) { flags.publish_every = static_cast<std::uint32_t>(n); });
  add_whole(command,
            {"--publish-latest", "0|1", "1: who is slow gets the newest cloud only [0]", group},
            {0, 1}, [&flags](std::int64_t n) { flags.publishes_newest = n == 1; });
  add_whole(
      command,
      {"--publish-queue", "N", "Clouds that wait for each subscriber, 0: any number [32]", group},
      {0, kMaxQueued}, [&flags](std::int64_t n) { flags.publish_queue = static_cast<int>(n); });
}

void add_pose_source_flags(CLI::App& command, StreamFlags& flags) {
  const std::string group = "Poses over ZeroMQ, as in 2015 (handshake at the next port)";
  add_whole(command, {"--physics-port", "P", "Port of a simulator that publishes poses", group},
            kPorts,
            [&flags](std::int64_t n) { flags.physics_port = static_cast<std::uint16_t>(n); });
  add_text(command, {"--physics-host", "HOST", "Where it runs [127.0.0.1]", group},
           flags.physics_host);
  add_whole(
      command,
      {"--pose-queue", "N", "Poses that wait, each gives a frame; 0: the newest only [0]", group},
      {0, kMaxQueued}, [&flags](std::int64_t n) { flags.pose_queue = static_cast<int>(n); });
  add_number(command,
             {"--pose-timeout", "S", "Ends when no pose comes for S seconds [none]", group},
             flags.pose_timeout_s);
}

void add_lockstep_flags(CLI::App& command, StreamFlags& flags) {
  const std::string group = "Lock-step over ZeroMQ: clients ask for every frame";
  add_text(
      command,
      {"--lockstep", "ADDRESS", "Answers at tcp://HOST:PORT (* any port) or ipc://PATH", group},
      flags.lockstep,
      [](std::string_view, const std::string& text) { (void)link::parse_endpoint(text); });
  add_text(command,
           {"--curve-keys", "FILE", "Encrypts with these keys; made when FILE is not there", group},
           flags.curve_keys);
}

void add_limit_flag(CLI::App& command, StreamFlags& flags) {
  CLI::Option* const option = command.add_option_function<std::vector<std::string>>(
      "--limit",
      [&flags](const std::vector<std::string>& given) {
        for (const std::string& one : given) set_limit(flags.limits, one);
      },
      "Limits what peers may use, repeatable (docs/link.md)");
  option->type_name("NAME=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  option->group("Limits of peers");
}

bool writes_files(const OutputFlags& files) {
  return !files.paths.empty() || !files.legacy_name.empty();
}

/// Requests say when and where; nothing else may.
void check_lockstep(const StreamFlags& flags) {
  const MotionFlags& motion = flags.render.motion;
  const OutputFlags& files = flags.render.output;
  const bool is_moved =
      !motion.trajectory.empty() || !motion.model_dr.empty() || !motion.camera_dr.empty();
  if (flags.port || flags.physics_port || is_moved || flags.frames || flags.is_unpaced ||
      flags.render.duration_s) {
    refuse_stream("--lockstep", "given beside options that say when frames are taken or what moves",
                  "leave these out: the requests say it");
  }
  const StreamFlags usual;
  if (flags.pose_timeout_s || flags.subscribers != usual.subscribers || flags.publishes_newest ||
      flags.subscription_timeout_s != usual.subscription_timeout_s ||
      flags.publish_every != usual.publish_every || flags.publish_queue != usual.publish_queue) {
    refuse_stream("--lockstep", "given beside options of the protocol of 2015", "leave these out");
  }
  if (files != OutputFlags{}) {
    refuse_stream("--lockstep", "given beside --output, --pcd or options of such files",
                  "leave these out: the clients get the clouds, with the columns they ask for");
  }
}

void check_simulator(const StreamFlags& flags) {
  const MotionFlags& motion = flags.render.motion;
  if (!motion.trajectory.empty() || !motion.model_dr.empty() || !motion.camera_dr.empty()) {
    refuse_stream("--physics-port", "given beside --trajectory, --object-rate or --sensor-rate",
                  "let either the simulator or the command line move things");
  }
  if (!flags.port) return;
  const int apart = int{*flags.port} - int{*flags.physics_port};
  if (std::abs(apart) <= 1 && flags.physics_host == flags.bind) {
    refuse_stream("--port and --physics-port", "each takes the next port too, so they overlap",
                  "keep them two apart");
  }
}

}  // namespace

void add_stream_flags(CLI::App& command, StreamFlags& flags) {
  add_render_flags(command, flags.render);
  hide_standard_output(command);
  add_pace_flags(command, flags);
  add_publishing_flags(command, flags);
  add_pose_source_flags(command, flags);
  add_lockstep_flags(command, flags);
  add_limit_flag(command, flags);
}

void add_replay_flags(CLI::App& command, StreamFlags& flags) {
  add_output_flags(command, flags.render.output);
  hide_standard_output(command);
  const std::string group = "Pace and end";
  add_option(command,
             {"--rate", "HZ", "Frames per second at most; 0 or max: no limit [max]", group},
             [&flags](std::string_view option, const std::string& text) {
               constexpr double kMax_hz = 1e9;
               const double rate_hz = text == "max" ? 0.0 : parse_number(option, text);
               require(rate_hz >= 0.0 && rate_hz <= kMax_hz, option, rate_hz, "0 to 1e9, or max");
               flags.replay_rate_hz = rate_hz;
             });
  add_whole(command, {"--frames", "N", "Ends after N frames, of all sensors together [all]", group},
            {1, std::numeric_limits<std::uint32_t>::max()},
            [&flags](std::int64_t n) { flags.frames = static_cast<std::uint64_t>(n); });
  add_text(command, {"--stats", "FILE", "Writes counts and latencies as JSON at the end", group},
           flags.stats);
  add_publishing_flags(command, flags);
  add_limit_flag(command, flags);
  constexpr std::int64_t kMaxThreads = 1024;
  add_whole(command, {"--threads", "N", "Number of threads, 0: one per processor [0]", "Run"},
            {0, kMaxThreads},
            [&flags](std::int64_t n) { flags.render.renderer.threads = static_cast<unsigned>(n); });
  command.add_flag("--quiet", flags.render.quiet, "No summary and no progress; warnings stay")
      ->group("Run");
}

StreamFlags replayed(StreamFlags recorded, const StreamFlags& chosen) {
  StreamFlags flags = chosen;
  flags.physics_port = recorded.physics_port;
  flags.render = std::move(recorded.render);
  flags.render.output = chosen.render.output;
  flags.render.renderer.threads = chosen.render.renderer.threads;
  flags.render.quiet = chosen.render.quiet;
  flags.render.duration_s.reset();
  return flags;
}

void check(const StreamFlags& flags) {
  if (flags.durability != link::Durability::none && flags.record.empty()) {
    refuse_stream("--durable", "given without --record",
                  "it is about recordings alone: give --record too");
  }
  if (!flags.lockstep.empty()) return check_lockstep(flags);
  if (!flags.curve_keys.empty()) {
    refuse_stream("--curve-keys", "given without --lockstep", "only that link is encrypted");
  }
  const OutputFlags& files = flags.render.output;
  if (!flags.port && !writes_files(files) && flags.record.empty()) {
    refuse_stream("--port and --output", "neither is given, so no cloud would go anywhere",
                  "for example: glidar stream " + flags.render.input + " --port 5555");
  }
  if (!writes_files(files) && files != OutputFlags{}) {
    refuse_stream("--output", "not given, but options of such files are",
                  "leave these out: clouds on a port are laid out as in 2015");
  }
  if (flags.physics_port) check_simulator(flags);
  const auto check_seconds = [](const char* option, const std::optional<double>& seconds) {
    if (seconds) {
      require(*seconds > 0.0 && *seconds <= kLongest_s, option, *seconds,
              "seconds above 0, up to 3.2e9");
    }
  };
  check_seconds("--duration", flags.render.duration_s);
  check_seconds("--pose-timeout", flags.pose_timeout_s);
  if (flags.pose_timeout_s && !flags.physics_port) {
    refuse_stream("--pose-timeout", "there is no --physics-port", "give --physics-port too");
  }
}

std::vector<std::string> taken_files(const StreamFlags& flags, std::vector<std::string> read) {
  if (!flags.curve_keys.empty()) read.push_back(flags.curve_keys);
  for (const std::string& file : {flags.replay, flags.stats, flags.record}) {
    if (file.empty()) continue;
    refuse_overwrite_of_inputs(read, file);
    read.push_back(file);
  }
  return read;
}

legacy::CloudPublisherOptions publisher_options(const StreamFlags& flags) {
  return {
      .endpoint = {flags.bind, *flags.port},
      .keeps_newest = flags.publishes_newest,
      .queue = flags.publish_queue,
      .every = flags.publish_every,
      .limits = flags.limits,
      .timestamps = flags.physics_port ? legacy::Timestamps::of_poses : legacy::Timestamps::counted,
      .subscription_timeout = std::chrono::round<std::chrono::milliseconds>(
          std::chrono::duration<double>(flags.subscription_timeout_s))};
}

legacy::PoseReceiverOptions receiver_options(const StreamFlags& flags) {
  return {.endpoint = {flags.physics_host, *flags.physics_port}, .queue = flags.pose_queue};
}

}  // namespace glidar::app
