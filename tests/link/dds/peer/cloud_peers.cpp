// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_peers.hpp"

#include "../network/participants.hpp"
#include "program.hpp"

#include <glidar/link/dds/participant.hpp>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <iostream>

namespace glidar::testing {
namespace {

using Time = std::chrono::steady_clock;

constexpr std::uint32_t kLast = 0xFFFFFFFF;
const ros::MessageType& kType = ros::message_type<ros::PointCloud2>();

std::byte pattern(std::size_t i, std::uint32_t number) {
  return static_cast<std::byte>(i * 7 + number);
}

/// The width is the number of the cloud.
link::Payload make_cloud(std::size_t bytes, std::uint32_t number) {
  ros::PointCloud2 cloud;
  cloud.header.frame_id = "lidar";
  cloud.width = number;
  cloud.data = ros::Payload(bytes, [number](std::span<std::byte> to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = pattern(i, number);
  });
  return payload_of(cloud);
}

/// The number of a complete cloud.
std::optional<std::uint32_t> number_of(const link::Payload& message, std::size_t bytes) {
  const auto cloud = ros::deserialize<ros::PointCloud2>(message.bytes());
  const std::span<const std::byte> data = cloud.data.bytes();
  if (data.size() != bytes) return std::nullopt;
  for (std::size_t i = 0; i < data.size(); ++i) {
    if (data[i] != pattern(i, cloud.width)) return std::nullopt;
  }
  return cloud.width;
}

struct CloudReader {
  explicit CloudReader(std::size_t bytes)
      : reader(program.participant, {"/points", kType, kType.qos, bytes + 4096}, wake_up) {}

  Program program;
  dds::WakeUp wake_up;
  dds::TopicReader reader;
};

/// Until there is a writer of /points.
void wait_for_writer(const CloudReader& reader) {
  const dds::WakeUp seen;
  const dds::Publications publications(reader.program.participant, seen);
  soon([&] { return !publications.of("/points").empty(); });
}

/// Waits for a message or the input. True for the input.
bool waits_for_input(const dds::WakeUp& wake_up) {
  std::array<pollfd, 2> entries = {
      pollfd{.fd = wake_up.descriptor(), .events = POLLIN, .revents = 0},
      pollfd{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0}};
  poll(entries.data(), entries.size(), -1);
  wake_up.clear();
  return entries[1].revents != 0;
}

/// Writes the clouds; the longest call of write(). Empty: one was not sent.
std::optional<Time::duration> write_all(dds::TopicWriter& writer,
                                        const std::vector<link::Payload>& clouds, double rate_hz) {
  Time::duration slowest{};
  auto due = Time::now();
  for (const link::Payload& cloud : clouds) {
    if (rate_hz > 0.0) {
      soon([&] { return Time::now() >= due; });
      due +=
          std::chrono::duration_cast<Time::duration>(std::chrono::duration<double>(1.0 / rate_hz));
    }
    const auto begin = Time::now();
    if (!writer.write(cloud)) return std::nullopt;
    slowest = std::max(slowest, Time::now() - begin);
    if (rate_hz == 0.0 && !writer.wait_for_acknowledgements(kMaxWait)) return std::nullopt;
  }
  return slowest;
}

}  // namespace

int write_clouds(const CloudSeries& series) {
  Program program;
  dds::TopicWriter writer(program.participant, "/points", kType, kType.qos);
  if (!is_matched(writer)) return 1;
  print_line("matched");
  std::vector<link::Payload> clouds;
  for (std::uint32_t i = 0; i < series.count; ++i)
    clouds.push_back(make_cloud(series.bytes, i + 1 == series.count ? kLast : i));
  std::string line;
  std::getline(std::cin, line);
  const std::optional<Time::duration> slowest = write_all(writer, clouds, series.rate_hz);
  if (!slowest) return 1;
  print_line(fmt::format(R"({{"sent": {}, "slowest_s": {}}})", writer.count(),
                         std::chrono::duration<double>(*slowest).count()));
  while (std::getline(std::cin, line)) writer.write(clouds.back());
  return 0;
}

int count_clouds(std::size_t count, std::size_t bytes) {
  CloudReader clouds(bytes);
  std::size_t complete = 0;
  std::size_t damaged = 0;
  bool is_ending = false;
  while (complete + damaged < count && !is_ending) {
    is_ending = waits_for_input(clouds.wake_up);
    while (const auto message = clouds.reader.take())
      ++(number_of(*message, bytes) ? complete : damaged);
  }
  print_line(fmt::format(R"({{"complete": {}, "damaged": {}}})", complete, damaged));
  return 0;
}

int read_newest(std::size_t bytes) {
  CloudReader clouds(bytes);
  wait_for_writer(clouds);
  print_line("matched");
  std::string line;
  std::getline(std::cin, line);
  for (std::uint32_t last = 0; last != kLast;) {
    const auto message = wait_for(clouds.wake_up.descriptor(), [&] {
      clouds.wake_up.clear();
      return clouds.reader.take();
    });
    if (!message) return 1;
    last = number_of(*message, bytes).value();
    print_line(std::to_string(last));
  }
  return 0;
}

}  // namespace glidar::testing
