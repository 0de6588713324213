// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/advice.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/lockstep_run.hpp>
#include <apps/glidar/run/recorded_command.hpp>
#include <apps/glidar/run/stream_run.hpp>
#include <glidar/core/error.hpp>
#include <glidar/link/connection_guard.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <utility>

namespace glidar::app {
namespace {

constexpr const char* kStreamExamples = R"(Examples:
  glidar stream builtin:asteroid --object-rate 0,0.5,0 --rate 10 --port 5555
  glidar stream builtin:asteroid --rate max --port 5555 --subscribers 0 --stats stats.json
  glidar stream builtin:box --sensor VLP-16 --eye 0,0,0 --duration 0.2 -o scan.pcd
  glidar stream builtin:asteroid --object-rate 0,0.5,0 --foxglove 8765
  glidar stream builtin:box --sensor VLP-16 --eye 0,0,0 --duration 10 -o run.mcap
With your own files:
  glidar stream scene.yaml --trajectory poses.txt --duration 10 -o scan.pcd
Closed loop with a simulator that publishes poses at port 5557 and shakes hands at port 5558:
  glidar stream satellite.obj --pose-source tcp://127.0.0.1:5557 --pose-queue 100 --port 5555
Packets of a sensor by UDP; its drivers read the calibration from it (docs/packets.md):
  glidar stream builtin:box --sensor OS1-128 --eye 0,0,0 --udp 127.0.0.1
Topics of ROS 2, poses from it, and its clock, without a ROS installation (docs/ros2.md):
  glidar stream scene.yaml --ros2
  glidar stream scene.yaml --pose-source ros2:/odom --ros2
A client that sends all poses and requests every frame (docs/link.md):
  glidar stream scene.yaml --lockstep tcp://127.0.0.1:5600
Record, then repeat with the same bytes on any machine:
  glidar stream builtin:asteroid --object-rate 0,0.5,0 --frames 20 --record r.jsonl -o scan.pcd
  glidar replay r.jsonl
  glidar stream builtin:asteroid --frames 20 --record r.jsonl --durable   # survives a loss of power
Receive in Python (python3-zmq); docs/link.md describes all messages:
  s = zmq.Context().socket(zmq.SUB); s.connect("tcp://127.0.0.1:5555"); s.subscribe("c")

Clouds are 'c', uint64 timestamp, then x y z intensity as float32 for every hit, x left, y up,
z forward. Numbered files (-o) are those of `glidar render --duration`.
A pose message gives the poses of the scene and the sensor:
  p_sensor = R(q_sensor) (R(q_object)^T p_object + t)
Exit codes: 0 done, or the simulator ended; 2 bad input; 3 no pose for --pose-timeout;
130 after Ctrl-C, 143 after SIGTERM. Subscribers always receive a message at the end.)";

int run_stream(const StreamFlags& given) {
  StreamFlags flags = given;
  link::raise_descriptor_limit(2 * flags.limits.connections);
  Console console(flags.render.quiet);
  if (!flags.lockstep.empty()) return LockstepRun(flags, console).run();
  StreamRun stream(std::move(flags), console);
  return stream.run();
}

}  // namespace

Command add_stream(CLI::App& program, const std::vector<std::string>& arguments) {
  CLI::App& command =
      *program.add_subcommand("stream", "Measure continuously: poses in, point clouds out");
  const auto flags = std::make_shared<StreamFlags>();
  command.footer(output_names_text() + kStreamExamples);
  add_stream_options(command, *flags);
  return [flags, arguments, &command] {
    check(command, *flags);
    if (has_pose_source(*flags) || !flags->lockstep.empty())
      flags->render.motion.stamp_origin = StampOrigin::source;
    flags->command = {.arguments = reproducible_arguments(arguments),
                      .folder = std::filesystem::current_path()};
    return run_stream(*flags);
  };
}

}  // namespace glidar::app
