// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/velodyne_packet.hpp>

#include <glidar/io/packets/packet_bytes.hpp>

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>

namespace glidar {
namespace {

constexpr std::size_t kBlockBytes = 4 + 3 * kVelodyneBlockPoints;
constexpr std::size_t kHourOffset = 0xC6;  // of a position packet
constexpr std::size_t kNmeaOffset = 0xCE;
constexpr std::size_t kMaxNmea = 128;
constexpr std::int64_t kMicrosecond = 1'000;
constexpr std::int64_t kHour_us = 3'600'000'000;

VelodynePacket::Block decode_block(ByteView bytes) {
  VelodynePacket::Block block;
  block.flag = get<std::uint16_t>(bytes, 0);
  block.azimuth = get<std::uint16_t>(bytes, 2);
  for (std::size_t i = 0; i < kVelodyneBlockPoints; ++i) {
    block.distance[i] = get<std::uint16_t>(bytes, 4 + 3 * i);
    block.reflectivity[i] = get<std::uint8_t>(bytes, 6 + 3 * i);
  }
  return block;
}

std::int64_t floor_divide(std::int64_t value, std::int64_t by) {
  const std::int64_t quotient = value / by;
  return value % by < 0 ? quotient - 1 : quotient;
}

/// Degrees as NMEA writes them: whole degrees and minutes with four decimals.
std::string nmea_angle(double angle_deg, int digits, const char* sides) {
  const auto minutes_e4 = static_cast<long long>(std::llround(std::abs(angle_deg) * 60.0 * 1e4));
  const long long degrees = minutes_e4 / 600'000;
  const double minutes = static_cast<double>(minutes_e4 % 600'000) * 1e-4;
  return fmt::format("{:0{}}{:07.4f},{}", degrees, digits, minutes, sides[angle_deg < 0.0 ? 1 : 0]);
}

}  // namespace

std::vector<std::byte> encode(const VelodynePacket& packet) {
  Bytes bytes;
  bytes.reserve(kVelodynePacketBytes);
  for (const VelodynePacket::Block& block : packet.blocks) {
    put_little(bytes, block.flag, 2);
    put_little(bytes, block.azimuth, 2);
    for (std::size_t i = 0; i < kVelodyneBlockPoints; ++i) {
      put_little(bytes, block.distance[i], 2);
      put_little(bytes, block.reflectivity[i], 1);
    }
  }
  put_little(bytes, packet.hour_us, 4);
  put_little(bytes, packet.mode, 1);
  put_little(bytes, packet.model, 1);
  return bytes;
}

VelodynePacket decode_velodyne_packet(std::span<const std::byte> payload) {
  require_packet_size(payload, kVelodynePacketBytes, "Velodyne data packet");
  VelodynePacket packet;
  for (std::size_t i = 0; i < kVelodyneBlocks; ++i)
    packet.blocks[i] = decode_block(payload.subspan(i * kBlockBytes, kBlockBytes));
  packet.hour_us = get<std::uint32_t>(payload, kVelodyneBlocks * kBlockBytes);
  packet.mode = get<std::uint8_t>(payload, kVelodynePacketBytes - 2);
  packet.model = get<std::uint8_t>(payload, kVelodynePacketBytes - 1);
  return packet;
}

std::vector<std::byte> encode(const VelodynePosition& position) {
  if (position.nmea.size() > kMaxNmea - 2) {
    throw Error({"Velodyne position packet", std::to_string(position.nmea.size()) + " characters",
                 "at most 126 characters"});
  }
  Bytes bytes(kHourOffset);
  put_little(bytes, position.hour_us, 4);
  put_little(bytes, position.pps_state, 1);
  bytes.resize(kNmeaOffset);
  for (const char letter : position.nmea + "\r\n") bytes.push_back(static_cast<std::byte>(letter));
  bytes.resize(kVelodynePositionBytes);
  return bytes;
}

VelodynePosition decode_velodyne_position(std::span<const std::byte> payload) {
  require_packet_size(payload, kVelodynePositionBytes, "Velodyne position packet");
  VelodynePosition position;
  position.hour_us = get<std::uint32_t>(payload, kHourOffset);
  position.pps_state = get<std::uint8_t>(payload, kHourOffset + 4);
  for (std::size_t i = kNmeaOffset; i < kNmeaOffset + kMaxNmea; ++i) {
    const auto letter = std::to_integer<unsigned char>(payload[i]);
    if (letter < 0x20U || letter > 0x7EU) break;  // the line's end, or no text
    position.nmea.push_back(static_cast<char>(letter));
  }
  return position;
}

std::string nmea_rmc(std::int64_t stamp_ns, double latitude_deg, double longitude_deg,
                     bool has_fix) {
  using std::chrono::days;
  using std::chrono::seconds;
  const std::chrono::sys_seconds time{seconds(floor_divide(stamp_ns, 1'000'000'000))};
  const auto day = std::chrono::floor<days>(time);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss clock{time - day};
  const std::string body = fmt::format(
      "GPRMC,{:02}{:02}{:02},{},{},{},000.0,000.0,{:02}{:02}{:02},000.0,E", clock.hours().count(),
      clock.minutes().count(), clock.seconds().count(), has_fix ? 'A' : 'V',
      nmea_angle(latitude_deg, 2, "NS"), nmea_angle(longitude_deg, 3, "EW"),
      static_cast<unsigned>(date.day()), static_cast<unsigned>(date.month()),
      std::abs(static_cast<int>(date.year())) % 100);
  unsigned sum = 0;
  for (const char letter : body) sum ^= static_cast<unsigned char>(letter);
  return fmt::format("${}*{:02X}", body, sum);
}

std::uint32_t hour_us(std::int64_t stamp_ns) {
  const std::int64_t us = floor_divide(stamp_ns, kMicrosecond);
  return static_cast<std::uint32_t>(us - floor_divide(us, kHour_us) * kHour_us);
}

std::int64_t stamp_in_hour(std::uint32_t hour_us, std::int64_t near_ns) {
  const std::int64_t near_us = floor_divide(near_ns, kMicrosecond);
  const std::int64_t late_us = near_us - std::int64_t{hour_us};
  const std::int64_t hours = floor_divide(late_us + kHour_us / 2, kHour_us);
  return (hours * kHour_us + std::int64_t{hour_us}) * kMicrosecond;
}

}  // namespace glidar
