// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <apps/glidar/options/message_options.hpp>
#include <apps/glidar/options/render_options.hpp>
#include <glidar/link/connection_guard.hpp>
#include <glidar/link/endpoint.hpp>
#include <glidar/output/network.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// A stream as given on the command line.
struct StreamFlags {
  RenderFlags render;
  bool is_unpaced = false;                    ///< --rate max
  std::optional<std::uint64_t> frames;        ///< empty: no such limit
  std::string stats;                          ///< file; empty: none
  std::string record;                         ///< file with all inputs of the frames; empty: none
  bool is_durable = false;                    ///< syncs that file to the disk
  std::string replay;                         ///< recording to repeat; empty: none
  std::optional<double> replay_rate_hz;       ///< 0: as fast as possible; empty: not given
  bool replays_requests = false;              ///< the recorded poses are those of clients
  CommandRecord command;                      ///< this command line, for the recording
  std::string bind = "127.0.0.1";             ///< address to listen at
  std::optional<std::uint16_t> port;          ///< of the clouds; empty: they are not published
  std::uint64_t subscribers = 1;              ///< handshakes to wait for
  double subscription_timeout_s = 10.0;       ///< for subscriptions after the handshake
  std::uint32_t publish_every = 1;            ///< frames
  bool publishes_latest = false;              ///< --publish-latest
  int publish_queue = 32;                     ///< clouds for each subscriber
  std::vector<PacketTarget> udp;              ///< receivers of packets
  PacketControl control;                      ///< of the sensors whose packets are sent
  std::optional<link::Endpoint> foxglove;     ///< of the live view; empty: there is none
  std::optional<link::Endpoint> pose_source;  ///< empty: the command line gives the poses
  Ros2Flags ros2;
  int pose_queue = 0;                    ///< 0: the newest pose only
  std::optional<double> pose_timeout_s;  ///< empty: none
  std::string lockstep;                  ///< endpoint at which requests are answered; empty: none
  std::string curve_keys;  ///< file of the keys that it is encrypted with; empty: no encryption
  link::Limits limits;     ///< of peers
};

/// Whether a simulator or ROS 2 gives the poses or the time.
inline bool has_pose_source(const StreamFlags& flags) {
  return flags.pose_source || !flags.ros2.pose_topic.empty();
}

/// Adds MODEL and all options of `stream`.
void add_stream_options(CLI::App& command, StreamFlags& flags);

/// Adds the options that `replay` may change; the recording gives all others.
void add_replay_options(CLI::App& command, StreamFlags& flags);

/// Throws Error when the options of `stream` contradict each other or write and publish nothing.
void check(const CLI::App& command, const StreamFlags& flags);

/// The files read, and those of statistics and recordings: no output may replace any of them.
/// Throws Error when one of these would.
std::vector<std::string> reserved_files(const StreamFlags& flags, std::vector<std::string> read);

}  // namespace glidar::app
