// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/stream_options.hpp>
#include <apps/glidar/run/stream_stats.hpp>
#include <glidar/woods2016/cloud_publisher.hpp>
#include <glidar/woods2016/pose_receiver.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace glidar::app {

/// The result of a stream.
struct StreamSummary {
  const StreamStats& stats;
  std::string ending;
  std::uint64_t measured = 0;  ///< frames
  std::uint64_t late = 0;      ///< frames after their due time
  std::optional<woods2016::CloudPublisher::Counts> clouds = {};
  std::optional<woods2016::PoseReceiver::Counts> poses = {};
  std::map<std::string, std::uint64_t> errors = {};
};

/// The JSON of --stats; docs/link.md describes every key.
std::string json_text(const StreamSummary& summary);

/// The summary that is printed at the end.
std::string summary_text(const StreamSummary& summary);

/// The message while the stream waits for peers.
std::string waiting_text(const StreamFlags& flags);

/// How many of the awaited subscribers will receive the next cloud.
std::string ready_text(std::uint64_t ready, std::uint64_t expected);

/// The part of the status line about subscribers.
std::string publishing_text(const woods2016::CloudPublisher::Counts& counts);

}  // namespace glidar::app
