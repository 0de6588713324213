// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Publishes a drive through a street at 10 Hz, for the tests of the live view and for development.
//   glidar_foxglove_feed [SENSOR [PORT [FRAMES]]]
// Prints the address, and one line per command of the page. Ends at the end of its input.
#include <glidar/core/error.hpp>
#include <glidar/io/ros/codec.hpp>
#include <glidar/link/foxglove/server.hpp>

#include "ros_bytes.hpp"
#include "street_drive.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace glidar::testing {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kPeriod_ns = 100'000'000;
constexpr std::uint64_t kStart_ns = 1'000'000'000'000;

/// What the page has requested.
struct Requests {
  struct Question {
    foxglove::Pick pick;
    foxglove::PickReply reply;
  };
  std::mutex mutex;
  bool is_playing = true;
  int steps = 0;
  std::deque<Question> questions;
};

struct Channels {
  foxglove::ChannelId cloud, depth, picture, tf, tf_static, odometry, boxes;
};

void obey(Requests& requests, foxglove::PlaybackCommand command) {
  const std::lock_guard lock(requests.mutex);
  std::printf("command %d\n", static_cast<int>(command));
  std::fflush(stdout);
  if (command == foxglove::PlaybackCommand::step) ++requests.steps;
  requests.is_playing = command == foxglove::PlaybackCommand::play;
}

/// A PNG of 2 x 2 pixels: red, green, blue, white.
std::string tiny_png() {
  constexpr std::array<unsigned char, 75> kBytes = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
      0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x02, 0x00, 0x00, 0x00, 0xfd,
      0xd4, 0x9a, 0x73, 0x00, 0x00, 0x00, 0x12, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0xf8,
      0xcf, 0xc0, 0xc0, 0x00, 0xc2, 0x0c, 0xff, 0x81, 0x00, 0x00, 0x1f, 0xee, 0x05, 0xfb, 0x0b,
      0xd9, 0x68, 0x8b, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  return {reinterpret_cast<const char*>(kBytes.data()), kBytes.size()};
}

Channels add_channels(foxglove::FoxgloveServer& server) {
  const auto add = [&](const char* topic, const ros::MessageType& type, std::size_t depth = 1) {
    return server.add_channel({.topic = topic,
                               .schema_name = std::string(type.name),
                               .schema = ros::definition_text(type),
                               .depth = depth});
  };
  const ros::MessageType& transforms = ros::message_type<ros::TFMessage>();
  return {.cloud = add("/points", ros::message_type<ros::PointCloud2>()),
          .depth = add("/camera/depth", ros::message_type<ros::Image>()),
          .picture = add("/camera/compressed", ros::message_type<ros::CompressedImage>()),
          .tf = add("/tf", transforms, 100),
          .tf_static = add("/tf_static", transforms),
          .odometry = add("/odom", ros::message_type<ros::Odometry>(), 100),
          .boxes = add("/boxes", ros::message_type<ros::MarkerArray>())};
}

/// Two cubes beside the sensor, of which the second has all parts of a marker.
link::Payload boxes_at(std::uint64_t stamp_ns) {
  ros::Marker cube;
  cube.header = {.stamp = ros::time_from_ns(static_cast<std::int64_t>(stamp_ns)),
                 .frame_id = "lidar"};
  cube.type = ros::Marker::kCube;
  cube.pose.position = {5.0, 2.0, 0.0};
  cube.scale = {4.0, 1.8, 1.5};
  cube.color = {1.0F, 0.5F, 0.0F, 0.3F};
  ros::Marker other = cube;
  other.id = 1;
  other.ns = "car";
  other.pose.position.y = -2.0;
  other.points = {{1.0, 2.0, 3.0}};
  other.colors = {{}};
  other.texture_resource = "texture";
  other.texture.format = "png";
  other.uv_coordinates = {{0.5F, 0.5F}};
  other.text = "a car";
  other.mesh_file.filename = "car.obj";
  const std::vector<std::byte> bytes = ros::serialize(ros::MarkerArray{{cube, other}});
  link::Payload payload = link::PayloadPool().take(bytes.size());
  std::memcpy(payload.memory.get(), bytes.data(), bytes.size());
  return payload;
}

/// Forward and back again.
int frame_at(std::uint64_t count, int frames) {
  const int period = frames > 1 ? 2 * (frames - 1) : 1;
  const int phase = static_cast<int>(count % static_cast<std::uint64_t>(period));
  return phase < frames ? phase : period - phase;
}

void publish(foxglove::FoxgloveServer& server, const Channels& to, const StreetDrive& drive,
             std::uint64_t count) {
  const int frame = frame_at(count, drive.frames());
  const std::uint64_t stamp = kStart_ns + count * kPeriod_ns;
  server.publish_time(stamp);
  server.publish(to.tf, stamp, drive.transform(frame, stamp));
  server.publish(to.odometry, stamp, drive.odometry(frame, stamp));
  server.publish(to.cloud, stamp, drive.cloud(frame, stamp));
  server.publish(to.depth, stamp, drive.depth_image(frame, stamp));
  server.publish(to.boxes, stamp, boxes_at(stamp));
}

void answer_question(Requests& requests, StreetDrive& drive) {
  std::optional<Requests::Question> question;
  {
    const std::lock_guard lock(requests.mutex);
    if (requests.questions.empty()) return;
    question = std::move(requests.questions.front());
    requests.questions.pop_front();
  }
  if (question->pick.topic != "/points" || question->pick.time_ns < kStart_ns) return;
  const std::uint64_t count = (question->pick.time_ns - kStart_ns) / kPeriod_ns;
  question->reply(drive.explain(frame_at(count, drive.frames()), question->pick.index));
}

/// Waits for the next frame; false at the end of the input.
bool wait(Clock::time_point until) {
  constexpr int kMax_ms = 20;
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now());
  pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  const int ready = ::poll(&input, 1, std::clamp(static_cast<int>(left.count()), 0, kMax_ms));
  char byte = 0;
  return ready <= 0 || ::read(STDIN_FILENO, &byte, 1) > 0;
}

/// Whether to publish another frame now.
bool is_next(Requests& requests) {
  const std::lock_guard lock(requests.mutex);
  if (requests.is_playing) return true;
  if (requests.steps == 0) return false;
  --requests.steps;
  return true;
}

void run(foxglove::FoxgloveServer& server, StreetDrive& drive, Requests& requests) {
  const Channels channels = add_channels(server);
  server.publish(channels.tf_static, kStart_ns, StreetDrive::static_transforms());
  CdrWriter picture;
  picture.header(kStart_ns, "camera").text("png").sequence(tiny_png());
  server.publish(channels.picture, kStart_ns, picture.payload());
  Clock::time_point next = Clock::now();
  for (std::uint64_t count = 0; wait(next);) {
    answer_question(requests, drive);
    if (Clock::now() < next) continue;
    next = std::max(next + std::chrono::nanoseconds(kPeriod_ns), Clock::now());
    if (is_next(requests)) publish(server, channels, drive, count++);
    const std::lock_guard lock(requests.mutex);
    server.set_playback(
        {.is_playing = requests.is_playing, .time_ns = kStart_ns + count * kPeriod_ns});
  }
}

int run_feed(int argc, char** argv) {
  try {
    Requests requests;
    StreetDrive drive(argc > 1 ? argv[1] : "VLP-16", argc > 3 ? std::atoi(argv[3]) : 20);
    link::ErrorLog errors({.log =
                               [](Severity, std::string_view text) {
                                 std::fprintf(stderr, "%.*s\n", static_cast<int>(text.size()),
                                              text.data());
                               },
                           .progress = {}});
    foxglove::ServerOptions options;
    options.at.port = static_cast<std::uint16_t>(argc > 2 ? std::atoi(argv[2]) : 0);
    options.on_playback = [&](foxglove::PlaybackCommand command) { obey(requests, command); };
    options.on_pick = [&](const foxglove::Pick& pick, foxglove::PickReply reply) {
      const std::lock_guard lock(requests.mutex);
      requests.questions.push_back({pick, std::move(reply)});
    };
    foxglove::FoxgloveServer server(options, errors);
    std::printf("http://127.0.0.1:%d/\n", server.port());
    std::fflush(stdout);
    run(server, drive, requests);
    const foxglove::ServerCounts counts = server.counts();
    std::printf("sent %llu dropped %llu\n", static_cast<unsigned long long>(counts.sent),
                static_cast<unsigned long long>(counts.dropped));
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace glidar::testing

int main(int argc, char** argv) {
  return glidar::testing::run_feed(argc, argv);
}
