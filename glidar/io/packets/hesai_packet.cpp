// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/hesai_packet.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/packet_bytes.hpp>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <string>
#include <string_view>
#include <utility>

namespace glidar {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::uint8_t kFactory = 0x42;

// Numbers of models: tier4/nebula, hesai_cmd_response.hpp. Block times: tier4/nebula,
// pandar_64.hpp, pandar_qt64.hpp, pandar_xt32.hpp. Its firing times of the QT64 are 10 us later
// than those of the preset, which the offset of its blocks contains here.
constexpr std::array<HesaiModel, 3> kHesaiModels = {{
    {"Pandar64", 64, 6, 3, 8, 26, {0xEE, 0xFF, 64, 6}, 55'560.0, -42'580.0, true, 2},
    {"PandarQT", 64, 4, 4, 12, 28, {0xEE, 0xFF, 3, 1}, 500'000.0 / 3.0, 35'710.0, false, 15},
    {"XT32", 32, 8, 4, 12, 28, {0xEE, 0xFF, 6, 1}, 50'000.0, 0.0, true, 25},
}};

/// Offsets in the tail.
struct TailPlaces {
  std::size_t mode = 0;
  std::size_t motor = 0;
  std::size_t date = 0;
  std::size_t microseconds = 0;
  std::size_t factory = 0;
  int first_year = 2000;
};

TailPlaces places_of(const HesaiModel& model) {
  if (model.channels == 32) return {10, 11, 13, 19, 23, 1900};
  if (model.point_bytes == 3) return {14, 8, 16, 10, 15, 2000};
  return {16, 10, 18, 12, 17, 1900};
}

std::size_t block_bytes(const HesaiModel& model) {
  return 2 + model.channels * model.point_bytes;
}

/// Whether the name contains that of the model and not a longer one, such as XT32M of XT32.
bool names_model(std::string_view name, std::string_view model) {
  const std::size_t begin = name.find(model);
  if (begin == std::string_view::npos) return false;
  const std::string_view rest = name.substr(begin + model.size());
  return rest.empty() || std::isalnum(static_cast<unsigned char>(rest.front())) == 0;
}

void set_little(Bytes& bytes, std::size_t at, std::uint64_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) bytes[at + i] = static_cast<std::byte>(value >> (8 * i));
}

}  // namespace

const HesaiModel* find_hesai_model(const Sensor& sensor) {
  for (const HesaiModel& model : kHesaiModels)
    if (names_model(sensor.name, model.name)) return &model;
  return nullptr;
}

double sequence_start_ns(const HesaiModel& model, std::size_t sequence, std::size_t sequences) {
  const double after = static_cast<double>(sequence);
  const double from = model.counts_from_last ? static_cast<double>(sequences) - 1.0 : 0.0;
  return model.block_offset_ns + (after - from) * model.block_period_ns;
}

std::vector<std::byte> encode(const HesaiPacket& packet, const HesaiModel& model) {
  Bytes bytes = packet.head;
  for (const HesaiPacket::Block& block : packet.blocks) {
    put_little(bytes, block.azimuth, 2);
    for (const HesaiPacket::Point& point : block.points) {
      put_little(bytes, point.distance, 2);
      put_little(bytes, point.reflectivity, 1);
      if (model.point_bytes == 4) put_little(bytes, point.confidence, 1);
    }
  }
  bytes.insert(bytes.end(), packet.tail.begin(), packet.tail.end());
  return bytes;
}

HesaiPacket decode_hesai_packet(std::span<const std::byte> payload, const HesaiModel& model) {
  const std::size_t body = model.blocks * block_bytes(model);
  require_packet_size(payload, model.head_bytes + body + model.tail_bytes, "Hesai data packet");
  for (std::size_t i = 0; i < 2; ++i) {
    if (get<std::uint8_t>(payload, i) == model.version[i]) continue;
    throw Error({"Hesai data packet", "another first number", "EE FF"});
  }
  HesaiPacket packet;
  packet.head.assign(payload.begin(),
                     payload.begin() + static_cast<std::ptrdiff_t>(model.head_bytes));
  packet.tail.assign(payload.end() - static_cast<std::ptrdiff_t>(model.tail_bytes), payload.end());
  for (std::size_t b = 0; b < model.blocks; ++b) {
    const ByteView bytes =
        payload.subspan(model.head_bytes + b * block_bytes(model), block_bytes(model));
    HesaiPacket::Block block{get<std::uint16_t>(bytes, 0), {}};
    for (std::size_t i = 0; i < model.channels; ++i) {
      const std::size_t at = 2 + i * model.point_bytes;
      HesaiPacket::Point point{get<std::uint16_t>(bytes, at), get<std::uint8_t>(bytes, at + 2)};
      if (model.point_bytes == 4) point.confidence = get<std::uint8_t>(bytes, at + 3);
      block.points.push_back(point);
    }
    packet.blocks.push_back(std::move(block));
  }
  return packet;
}

std::vector<std::byte> encode(const HesaiTail& tail, const HesaiModel& model) {
  using std::chrono::days;
  const TailPlaces at = places_of(model);
  const std::chrono::sys_time<std::chrono::nanoseconds> time{
      std::chrono::nanoseconds(tail.stamp_ns)};
  const auto day = std::chrono::floor<days>(time);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss clock{std::chrono::floor<std::chrono::seconds>(time) - day};
  const auto in_second = (time - std::chrono::floor<std::chrono::seconds>(time)).count();
  Bytes bytes(model.tail_bytes);
  set_little(bytes, at.mode, tail.return_mode, 1);
  set_little(bytes, at.motor, tail.motor_rpm, 2);
  const std::array<std::uint64_t, 6> numbers = {
      static_cast<std::uint64_t>(static_cast<int>(date.year()) - at.first_year),
      static_cast<unsigned>(date.month()),
      static_cast<unsigned>(date.day()),
      static_cast<std::uint64_t>(clock.hours().count()),
      static_cast<std::uint64_t>(clock.minutes().count()),
      static_cast<std::uint64_t>(clock.seconds().count())};
  for (std::size_t i = 0; i < numbers.size(); ++i) set_little(bytes, at.date + i, numbers[i], 1);
  set_little(bytes, at.microseconds, static_cast<std::uint64_t>(in_second / 1000), 4);
  set_little(bytes, at.factory, kFactory, 1);
  set_little(bytes, model.tail_bytes - 4, tail.sequence, 4);
  return bytes;
}

HesaiTail decode_hesai_tail(std::span<const std::byte> tail, const HesaiModel& model) {
  require_packet_size(tail, model.tail_bytes, "tail of a Hesai packet");
  const TailPlaces at = places_of(model);
  std::array<unsigned, 6> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = get<std::uint8_t>(tail, at.date + i);
  const std::chrono::year_month_day date{
      std::chrono::year(at.first_year + static_cast<int>(numbers[0])),
      std::chrono::month(numbers[1]), std::chrono::day(numbers[2])};
  const auto us = get<std::uint32_t>(tail, at.microseconds);
  if (!date.ok() || numbers[3] > 23 || numbers[4] > 59 || numbers[5] > 60 || us >= 2'000'000)
    throw Error({"Hesai data packet", "a time that is no date", ""});
  const std::int64_t day = std::chrono::sys_days(date).time_since_epoch().count();
  const std::int64_t seconds = ((day * 24 + numbers[3]) * 60 + numbers[4]) * 60 + numbers[5];
  return {get<std::uint8_t>(tail, at.mode), get<std::uint16_t>(tail, at.motor),
          seconds * kNanosecondsPerSecond + std::int64_t{us} * 1000,
          get<std::uint32_t>(tail, model.tail_bytes - 4)};
}

}  // namespace glidar
