// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/woods2016/message_codec.hpp>

#include <glidar/core/error.hpp>

#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

namespace glidar::woods2016 {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are little-endian");
static_assert(sizeof(CloudPoint) == 16, "points are copied without padding");

constexpr std::string_view kShutdown = "KTHXBAI";
constexpr std::size_t kHeadBytes = 1 + 8;
constexpr const char* kPoseMessage = "pose message ('v')";
constexpr const char* kCloudMessage = "cloud message ('c')";

/// A byte in readable form: 'v', or 0x07.
std::string byte_text(std::byte byte) {
  const auto value = std::to_integer<unsigned>(byte);
  if (value > 0x20 && value < 0x7f) return std::string("'") + static_cast<char>(value) + "'";
  constexpr std::string_view kDigits = "0123456789abcdef";
  return std::string("0x") + kDigits[value >> 4U] + kDigits[value & 0xfU];
}

void check_topic(const char* where, Bytes message, char topic) {
  if (message.empty())
    throw Error({where, "it is empty", std::string("'") + topic + "' and its content"});
  if (message[0] == static_cast<std::byte>(topic)) return;
  throw Error(
      {where, "its first byte is " + byte_text(message[0]), std::string("'") + topic + "'"});
}

/// The number at a valid offset.
template <class T>
T read(Bytes message, std::size_t offset) {
  T value;
  std::memcpy(&value, message.data() + offset, sizeof(T));
  return value;
}

template <class T>
void write(std::span<std::byte> message, std::size_t offset, T value) {
  std::memcpy(message.data() + offset, &value, sizeof(T));
}

/// Names of the numbers of a placement, for errors.
constexpr std::array kNumberNames = {"object w",      "object x",      "object y",      "object z",
                                     "translation x", "translation y", "translation z", "sensor w",
                                     "sensor x",      "sensor y",      "sensor z"};
using Numbers = std::array<double, kNumberNames.size()>;

void check_numbers(const Numbers& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool is_position = i >= 4 && i < 7;
    if (std::isfinite(numbers[i]) && (!is_position || std::abs(numbers[i]) <= kMaxCoordinate_m))
      continue;
    throw Error({kPoseMessage, std::string(kNumberNames[i]) + " is " + number_text(numbers[i]),
                 is_position ? "metres from -1e15 to 1e15" : "a finite number"});
  }
}

Eigen::Quaterniond unit_quaternion(const Numbers& numbers, std::size_t first, const char* name) {
  const Eigen::Quaterniond q(numbers[first], numbers[first + 1], numbers[first + 2],
                             numbers[first + 3]);
  const double length = q.coeffs().stableNorm();
  if (std::abs(length - 1.0) <= kQuaternionTolerance) return q.normalized();
  throw Error({kPoseMessage,
               std::string("the ") + name + "'s quaternion has the length " + number_text(length),
               "1 to within 0.001, in the order w x y z"});
}

/// The numbers of the column with this name and this many numbers per point.
template <class T>
const std::vector<T>& field_values(const PointCloud& cloud, const char* name,
                                   std::size_t components) {
  const Column* column = find_column(cloud, name);
  const auto* numbers = column == nullptr ? nullptr : std::get_if<std::vector<T>>(&column->values);
  if (numbers != nullptr && numbers->size() == components * cloud.size()) return *numbers;
  throw Error({kCloudMessage, std::string("the cloud has no column ") + name, "xyz and intensity"});
}

}  // namespace

Placement decode_placement(Bytes message) {
  check_topic(kPoseMessage, message, kPlacementTopic);
  if (message.size() != kPlacementBytes) {
    throw Error(
        {kPoseMessage, "it has " + std::to_string(message.size()) + " bytes",
         std::to_string(kPlacementBytes) + ": the byte 'v', a 64-bit timestamp, 11 doubles"});
  }
  Numbers numbers{};
  std::memcpy(numbers.data(), message.data() + kHeadBytes, sizeof(numbers));
  check_numbers(numbers);
  return {.timestamp = read<std::uint64_t>(message, 1),
          .object = unit_quaternion(numbers, 0, "object"),
          .translation_m = {numbers[4], numbers[5], numbers[6]},
          .sensor = unit_quaternion(numbers, 7, "sensor")};
}

std::array<std::byte, kPlacementBytes> encode_placement(const Placement& placement) {
  std::array<std::byte, kPlacementBytes> message{};
  const auto& [timestamp, object, t, sensor] = placement;
  const Numbers numbers = {object.w(), object.x(), object.y(), object.z(), t.x(),     t.y(),
                           t.z(),      sensor.w(), sensor.x(), sensor.y(), sensor.z()};
  write(std::span(message), 0, kPlacementTopic);
  write(std::span(message), 1, timestamp);
  write(std::span(message), kHeadBytes, numbers);
  return message;
}

Cloud decode_cloud(Bytes message) {
  check_topic(kCloudMessage, message, kCloudTopic);
  if (message.size() < kHeadBytes || (message.size() - kHeadBytes) % sizeof(CloudPoint) != 0) {
    throw Error({kCloudMessage, "it has " + std::to_string(message.size()) + " bytes",
                 "9, and 16 for every point"});
  }
  Cloud cloud;
  cloud.timestamp = read<std::uint64_t>(message, 1);
  cloud.points.resize((message.size() - kHeadBytes) / sizeof(CloudPoint));
  if (cloud.points.empty()) return cloud;
  std::memcpy(cloud.points.data(), message.data() + kHeadBytes, message.size() - kHeadBytes);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const auto& [x, y, z, intensity] = cloud.points[i];
    if (std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && std::isfinite(intensity))
      continue;
    throw Error({kCloudMessage, "point " + std::to_string(i) + " is not finite", "finite numbers"});
  }
  return cloud;
}

std::size_t encode_cloud(const PointCloud& cloud, std::uint64_t timestamp,
                         std::span<std::byte> to) {
  const auto& xyz = field_values<double>(cloud, "xyz", 3);
  const auto& intensity = field_values<float>(cloud, "intensity", 1);
  if (to.size() < cloud_bytes(cloud.size())) {
    throw Error({kCloudMessage, "there is room for " + std::to_string(to.size()) + " bytes",
                 std::to_string(cloud_bytes(cloud.size())) + " or more"});
  }
  write(to, 0, kCloudTopic);
  write(to, 1, timestamp);
  std::byte* place = to.data() + kHeadBytes;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const CloudPoint point = {static_cast<float>(xyz[3 * i]), static_cast<float>(xyz[3 * i + 1]),
                              static_cast<float>(xyz[3 * i + 2]), intensity[i]};
    // Every point is written, but kept only if it is a hit: faster than a branch per miss.
    std::memcpy(place, &point, sizeof(point));
    if (!std::isnan(point.x_m)) place += sizeof(point);
  }
  return static_cast<std::size_t>(place - to.data());
}

std::vector<std::byte> encode_shutdown(std::string_view topic) {
  std::vector<std::byte> message(topic.size() + kShutdown.size());
  std::memcpy(message.data(), topic.data(), topic.size());
  std::memcpy(message.data() + topic.size(), kShutdown.data(), kShutdown.size());
  return message;
}

bool is_shutdown(Bytes message) {
  return message.size() == 1 + kShutdown.size() &&
         std::memcmp(message.data() + 1, kShutdown.data(), kShutdown.size()) == 0;
}

}  // namespace glidar::woods2016
