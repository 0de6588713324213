// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/stream_options.hpp>

#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/files/atomic_file.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace glidar::app {
namespace {

constexpr std::uint16_t kMaxPort = 65534;  // the next port is for handshakes
constexpr int kMaxQueue = 1'000'000;
constexpr double kCentury_s = 3.2e9;
constexpr const char* kTimingHeading = "Timing";

/// Seconds of a limit that is above 0.
std::function<double(const std::string&)> positive_seconds() {
  return number(kAboveZero, kCentury_s, "seconds above 0, up to 3.2e9");
}

/// "max" is 0: no limit.
double parse_frame_rate(const std::string& text) {
  return text == "max" ? 0.0 : parse_number(text);
}

/// Throws Error that lists both kinds of sources, unlike parse_endpoint().
link::Endpoint parse_pose_source(const std::string& text) {
  link::Endpoint endpoint;
  try {
    endpoint = link::parse_endpoint(text);
  } catch (const Error&) {  // as below
  }
  if (!endpoint.path.empty() || endpoint.port == 0 || endpoint.port > kMaxPort) {
    refuse_value(text,
                 "tcp://HOST:PORT with a port from 1 to 65534, or ros2: and a topic with poses or "
                 "the clock",
                 "for example tcp://127.0.0.1:5557 or ros2:/odom");
  }
  return endpoint;
}

void add_end_options(const OptionGroup& group, const char* frames_help, StreamFlags& flags) {
  group.add("--frames", "N", frames_help, flags.frames,
            whole<std::uint64_t>(1, std::numeric_limits<std::uint32_t>::max()));
  group.add("--stats", "FILE", "Write counts and latencies as JSON at the end", flags.stats);
}

/// Replaces options of `render` whose meaning is different for streams.
void add_timing_options(CLI::App& command, StreamFlags& flags) {
  for (const char* name : {"--range-sigma", "--fisher", "--rate", "--duration"}) {
    command.remove_option(command.get_option(name));
  }
  const OptionGroup group(command, kTimingHeading);
  group.add("--rate", "HZ", "Frames per second; 0 or max: as fast as possible [sensor's]",
            [&flags](const std::string& text) {
              const double rate_hz = parse_frame_rate(text);
              flags.is_unpaced = rate_hz == 0.0;
              flags.render.sensor.rate_hz.reset();
              if (!flags.is_unpaced) flags.render.sensor.rate_hz = rate_hz;
            });
  group.add("--duration", "S", "End after S seconds [none]", flags.render.duration_s,
            positive_seconds());
  forbid_together(command, {"--duration"}, {"--to"});
  add_end_options(group, "End after N frames [none]", flags);
  group.add("--record", "FILE", "Keep poses, seeds and command for glidar replay", flags.record);
  group.add_flag("--durable", "Sync the finished --record file to the disk [off]",
                 flags.is_durable);
  require_option(command, {"--durable"}, "--record");
}

void add_publishing_options(CLI::App& command, StreamFlags& flags) {
  const OptionGroup group(
      command, "Clouds over ZeroMQ, protocol of Woods 2016 (handshakes at the next port)");
  group.add("-p,--port", "P", "Port that publishes the clouds [none]", flags.port,
            whole<std::uint16_t>(1, kMaxPort));
  group.add("--bind", "ADDRESS", "Address to listen at, * for all [127.0.0.1]", flags.bind);
  group.add("--subscribers", "N", "Wait for N subscribers that shake hands [1]", flags.subscribers,
            whole<std::uint64_t>(0, kMaxQueue));
  group.add("--subscription-timeout", "S", "Wait up to S seconds for their subscriptions [10]",
            flags.subscription_timeout_s, number(0.0, kCentury_s, "seconds from 0 up to 3.2e9"));
  group.add("--publish-every", "K", "Publish every K-th frame [1; the original GLIDAR: 15]",
            flags.publish_every, whole<std::uint32_t>(1, kMaxQueue));
  group.add("--publish-latest", "0|1", "1: slow subscribers get the newest cloud only [0]",
            [&flags](const std::string& text) { flags.publishes_latest = whole(0, 1)(text) == 1; });
  group.add("--publish-queue", "N", "Clouds queued for each subscriber, 0: no limit [32]",
            flags.publish_queue, whole(0, kMaxQueue));
}

/// "[ADDRESS:]PORT".
link::Endpoint parse_listen_address(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const bool has_host = colon != std::string::npos;
  link::Endpoint endpoint{.host = has_host ? text.substr(0, colon) : "127.0.0.1"};
  if (endpoint.host.starts_with('[') && endpoint.host.ends_with(']')) {
    endpoint.host = endpoint.host.substr(1, endpoint.host.size() - 2);
  }
  const std::string port = has_host ? text.substr(colon + 1) : text;
  const char* const end = port.data() + port.size();
  const auto [stop, error] = std::from_chars(port.data(), end, endpoint.port);
  if (error != std::errc() || stop != end || endpoint.host.empty()) {
    refuse_value(text, "PORT from 0 (any free port) to 65535, or ADDRESS:PORT",
                 "for example --foxglove 8765, or --foxglove as the last option");
  }
  return endpoint;
}

void add_live_view_option(CLI::App& command, StreamFlags& flags) {
  OptionGroup(command, "Live view in browsers, Foxglove and Lichtblick")
      .add_optional(
          "--foxglove", "[ADDRESS:]PORT", "Show the frames at this port [127.0.0.1:8765]", "8765",
          [&flags](const std::string& text) { flags.foxglove = parse_listen_address(text); });
}

ControlTarget parse_control_target(const std::string& text) {
  const PacketTarget parsed = parse_packet_target(text);
  if (parsed.second_port) refuse_value(text, "[SENSOR=]ADDRESS[:PORT]", "give one port");
  return {parsed.sensor_name, parsed.host == "*" ? "0.0.0.0" : parsed.host, parsed.data_port};
}

void add_packet_options(CLI::App& command, StreamFlags& flags) {
  const OptionGroup group(command,
                          "Packets by UDP, as Velodyne, Ouster, Hesai and Livox sensors send them");
  group.add_repeatable("--udp", "ADDRESS[:PORT[:PORT]]",
                       "Receiver; ports of data and IMU or position [the manufacturer's]",
                       [&flags](const std::string& text) {
                         with_option_name("--udp",
                                          [&] { flags.udp.push_back(parse_packet_target(text)); });
                       });
  group.add_repeatable("--control", "ADDRESS[:PORT]",
                       "Address of the sensor for its drivers, or none [on this machine]",
                       [&flags](const std::string& text) {
                         if (text == "none") {
                           flags.control.has_none = true;
                           return;
                         }
                         with_option_name("--control", [&] {
                           flags.control.chosen.push_back(parse_control_target(text));
                         });
                       });
  require_option(command, {"--control"}, "--udp");
}

void add_pose_source_options(CLI::App& command, StreamFlags& flags) {
  const OptionGroup group(command, "Poses by the protocol of Woods 2016 (ZeroMQ), or by ROS 2");
  group.add("--pose-source", "SOURCE",
            "tcp://HOST:PORT, ros2:/odom, ros2:/tf:A:B, ros2:/clock [none]",
            [&flags](const std::string& text) {
              if (text.starts_with(kRos2Prefix)) return set_ros2_pose_source(text, flags.ros2);
              flags.pose_source = parse_pose_source(text);
            });
  group.add("--pose-queue", "N", "Queued poses, each gives a frame; 0: the newest only [0]",
            flags.pose_queue, whole(0, kMaxQueue));
  group.add("--pose-timeout", "S", "End when no pose arrives for S seconds [none]",
            flags.pose_timeout_s, positive_seconds());
  require_option(command, {"--pose-timeout"}, "--pose-source");
}

/// Requests give times and poses, so that no other option may.
void add_lockstep_options(CLI::App& command, StreamFlags& flags) {
  const OptionGroup group(command, "Lock-step over ZeroMQ: clients request every frame");
  group.add("--lockstep", "ADDRESS", "Answer at tcp://HOST:PORT (* any port) or ipc://PATH",
            [&flags](const std::string& text) {
              (void)link::parse_endpoint(text);
              flags.lockstep = text;
            });
  group.add("--curve-keys", "FILE", "Encrypt with these keys; creates FILE if it does not exist",
            flags.curve_keys);
  require_option(command, {"--curve-keys"}, "--lockstep");
  forbid_together(command, {"--lockstep"},
                  {"--port",
                   "--foxglove",
                   "--udp",
                   "--ros2",
                   "--pose-source",
                   "--trajectory",
                   "--from",
                   "--to",
                   "--start-time",
                   "--object-rate",
                   "--sensor-rate",
                   "--frames",
                   "--duration",
                   "--subscribers",
                   "--subscription-timeout",
                   "--publish-every",
                   "--publish-latest",
                   "--publish-queue",
                   "--format",
                   "--legacy-output",
                   "--imu"});
  forbid_together(command, {"--lockstep"}, options_under(command, kOutputHeading));
}

void add_limit_option(CLI::App& command, StreamFlags& flags) {
  OptionGroup(command, "Limits of peers")
      .add_repeatable("--limit", "NAME=VALUE", "Limit of what peers may use, repeatable",
                      [&flags](const std::string& text) { set_limit(flags.limits, text); });
}

/// The clock of ROS 2 gives times only.
void check_motion(const CLI::App& command, const StreamFlags& flags) {
  if (!has_pose_source(flags)) return;
  OptionNames others = {"--start-time", "--from", "--to"};
  if (!follows_ros_clock(flags.ros2))
    others.insert(others.end(), {"--trajectory", "--object-rate", "--sensor-rate"});
  for (const std::string& name : others) {
    if (command.count(name) == 0) continue;
    throw Error({"--pose-source and " + name, "both are given", "", "give one of them"});
  }
}

void check_ports(const StreamFlags& flags) {
  if (!flags.port || !flags.pose_source || flags.pose_source->host != flags.bind) return;
  if (std::abs(int{*flags.port} - int{flags.pose_source->port}) > 1) return;
  throw Error({"--port and --pose-source", "each uses the next port too, so they overlap", "",
               "keep them two apart"});
}

}  // namespace

void add_stream_options(CLI::App& command, StreamFlags& flags) {
  add_render_options(command, flags.render);
  flags.render.output.per_frame = true;  // other programs read the files of a live stream
  hide_standard_output(command);
  add_timing_options(command, flags);
  add_publishing_options(command, flags);
  add_live_view_option(command, flags);
  add_packet_options(command, flags);
  add_ros2_options(command, flags.ros2);
  add_pose_source_options(command, flags);
  add_lockstep_options(command, flags);
  add_limit_option(command, flags);
}

void add_replay_options(CLI::App& command, StreamFlags& flags) {
  add_output_options(command, flags.render.output);
  add_box_classes_option(command, flags.render.output);
  flags.render.output.per_frame = true;
  add_legacy_output_option(command, flags.render.output);
  hide_standard_output(command);
  const OptionGroup timing(command, kTimingHeading);
  timing.add("--rate", "HZ", "Frames per second; 0: no limit [max; --foxglove: as recorded]",
             flags.replay_rate_hz, [](const std::string& text) {
               constexpr double kMax_hz = 1e9;
               const double rate_hz = parse_frame_rate(text);
               require_number(rate_hz >= 0.0 && rate_hz <= kMax_hz, "", rate_hz,
                              "0 to 1e9, or max");
               return rate_hz;
             });
  add_end_options(timing, "End after N frames, of all sensors together [all]", flags);
  add_publishing_options(command, flags);
  add_live_view_option(command, flags);
  add_packet_options(command, flags);
  add_ros2_options(command, flags.ros2);
  add_limit_option(command, flags);
  const OptionGroup run(command, "Run");
  add_threads_option(run, flags.render.renderer);
  run.add_flag("-q,--quiet", "No summary and no progress, only warnings", flags.render.quiet);
}

void check(const CLI::App& command, const StreamFlags& flags) {
  check_ros2_options(command, flags.ros2);
  if (!flags.lockstep.empty()) {
    if (!flags.is_unpaced) return;
    throw Error(
        {"--lockstep and --rate max", "requests give the times of frames", "", "leave --rate out"});
  }
  const bool has_clouds = has_outputs(flags.render.output) ||
                          has_run_outputs(flags.render.output) || flags.foxglove ||
                          !flags.udp.empty() || flags.ros2.publishes;
  if (!has_clouds) {
    if (!flags.port && flags.record.empty()) {
      throw Error({"--port, --foxglove, --udp, --ros2 and --output",
                   "none is given, so no cloud would be sent or written", "",
                   "for example: glidar stream " + flags.render.input + " --foxglove"});
    }
    OptionNames names = options_under(command, kOutputHeading);
    names.emplace_back("--format");
    const auto is_given = [&](const std::string& name) { return command.count(name) > 0; };
    if (std::any_of(names.begin(), names.end(), is_given)) {
      throw Error({"--output", "not given, but options of output files are", "",
                   "leave these out: clouds on a port have x, y, z and intensity"});
    }
  }
  check_motion(command, flags);
  check_ports(flags);
}

std::vector<std::string> reserved_files(const StreamFlags& flags, std::vector<std::string> read) {
  if (!flags.curve_keys.empty()) read.push_back(flags.curve_keys);
  for (const std::string& file : {flags.replay, flags.stats, flags.record}) {
    if (file.empty()) continue;
    refuse_overwrite_of_inputs(read, file);
    read.push_back(file);
  }
  return read;
}

}  // namespace glidar::app
