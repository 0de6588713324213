// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <apps/glidar/options/render_options.hpp>
#include <glidar/link/legacy/cloud_publisher.hpp>
#include <glidar/link/legacy/pose_receiver.hpp>
#include <glidar/link/limits.hpp>
#include <glidar/link/recording.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace glidar::app {

/// A stream as given on the command line.
struct StreamFlags {
  RenderFlags render;
  bool is_unpaced = false;              ///< --rate max
  std::optional<std::uint64_t> frames;  ///< empty: no such limit
  std::string stats;                    ///< file; empty: none
  std::string record;                   ///< file that keeps what the frames depend on; empty: none
  link::Durability durability = link::Durability::none;  ///< of that file
  std::string replay;                 ///< file of that kind that the frames come from; empty: none
  double replay_rate_hz = 0.0;        ///< 0: as fast as it goes
  CommandRecord command;              ///< this one, for the recording
  std::string bind = "127.0.0.1";     ///< address to listen at
  std::optional<std::uint16_t> port;  ///< of the clouds; empty: they are not published
  std::uint64_t subscribers = 1;      ///< handshakes to wait for
  double subscription_timeout_s = 10.0;  ///< for the subscriptions of those that shook hands
  std::uint32_t publish_every = 1;       ///< so many frames
  bool publishes_newest = false;         ///< --publish-latest
  int publish_queue = 32;                ///< clouds for each subscriber
  std::string physics_host = "127.0.0.1";
  std::optional<std::uint16_t> physics_port;  ///< of the poses; empty: from the command line
  int pose_queue = 0;                         ///< 0: the newest pose only
  std::string lockstep;    ///< endpoint at which requests are answered; empty: none
  link::Limits limits;     ///< of peers
  std::string curve_keys;  ///< file of the keys that it is encrypted with; empty: it is not
  std::optional<double> pose_timeout_s;  ///< empty: waits for ever
};

/// Adds MODEL and all options of `stream`.
void add_stream_flags(CLI::App& command, StreamFlags& flags);

/// Adds what `replay` may choose itself: all else is as recorded.
void add_replay_flags(CLI::App& command, StreamFlags& flags);

/// The stream that was recorded, with what `replay` may choose.
StreamFlags replayed(StreamFlags recorded, const StreamFlags& chosen);

/// Throws Error when the flags contradict each other or say nothing that could be done.
void check(const StreamFlags& flags);

/// The files read, and those of statistics and recordings: no output may replace any of them.
/// Throws Error when one of these would.
std::vector<std::string> taken_files(const StreamFlags& flags, std::vector<std::string> read);

legacy::CloudPublisherOptions publisher_options(const StreamFlags& flags);
legacy::PoseReceiverOptions receiver_options(const StreamFlags& flags);

}  // namespace glidar::app
