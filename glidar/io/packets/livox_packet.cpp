// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/livox_packet.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/packet_bytes.hpp>

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <string>

namespace glidar {
namespace {

constexpr std::size_t kLivoxHead = 36;
constexpr std::size_t kChecksumAt = 24;
constexpr std::size_t kStampAt = 28;
constexpr std::size_t kImuSample = 24;

/// Bytes of the three numbers of a point.
std::array<std::size_t, 3> number_bytes(LivoxDataType type) {
  if (type == LivoxDataType::cartesian_mm) return {4, 4, 4};
  if (type == LivoxDataType::cartesian_cm) return {2, 2, 2};
  return {4, 2, 2};
}

std::size_t livox_point_bytes(LivoxDataType type) {
  const std::array<std::size_t, 3> numbers = number_bytes(type);
  return numbers[0] + numbers[1] + numbers[2] + 2;
}

std::int64_t signed_number(std::uint64_t bits, std::size_t bytes) {
  if (bytes == 4) return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits));
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
}

LivoxPoint get_point(ByteView bytes, LivoxDataType type) {
  LivoxPoint point;
  std::size_t at = 0;
  const std::array<std::size_t, 3> sizes = number_bytes(type);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::uint64_t bits = get_little(bytes, at, sizes[i]);
    const bool is_signed = type != LivoxDataType::spherical;
    point.numbers[i] = is_signed ? signed_number(bits, sizes[i]) : static_cast<std::int64_t>(bits);
    at += sizes[i];
  }
  point.reflectivity = get<std::uint8_t>(bytes, at);
  point.tag = get<std::uint8_t>(bytes, at + 1);
  return point;
}

void put_point(Bytes& bytes, const LivoxPoint& point, LivoxDataType type) {
  const std::array<std::size_t, 3> sizes = number_bytes(type);
  for (std::size_t i = 0; i < sizes.size(); ++i)
    put_little(bytes, static_cast<std::uint64_t>(point.numbers[i]), sizes[i]);
  put_little(bytes, point.reflectivity, 1);
  put_little(bytes, point.tag, 1);
}

[[noreturn]] void fail_of_packet(std::string found, std::string allowed) {
  throw Error({"Livox packet", std::move(found), std::move(allowed)});
}

void check_head(ByteView payload) {
  if (payload.size() < kLivoxHead)
    fail_of_packet(std::to_string(payload.size()) + " bytes", "at least 36 bytes");
  if (get<std::uint8_t>(payload, 0) != 0)
    fail_of_packet("version " + std::to_string(get<std::uint8_t>(payload, 0)), "0");
  if (get<std::uint16_t>(payload, 1) != payload.size())
    fail_of_packet("a length of " + std::to_string(get<std::uint16_t>(payload, 1)),
                   std::to_string(payload.size()) + ", the bytes received");
  if (get<std::uint8_t>(payload, 10) > static_cast<std::uint8_t>(LivoxDataType::spherical))
    fail_of_packet("data type " + std::to_string(get<std::uint8_t>(payload, 10)), "0 to 3");
  if (get<std::uint32_t>(payload, kChecksumAt) != livox_crc32(payload.subspan(kStampAt)))
    throw Error({"Livox packet", "a wrong CRC-32", "", "discard the packet: it is damaged"});
}

}  // namespace

bool fits(const LivoxPoint& point, LivoxDataType type) {
  const std::array<std::size_t, 3> sizes = number_bytes(type);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::int64_t values = std::int64_t{1} << (8 * sizes[i]);
    const bool is_signed = type != LivoxDataType::spherical;
    const std::int64_t min = is_signed ? -values / 2 : 0;
    if (point.numbers[i] < min || point.numbers[i] >= min + values) return false;
  }
  return true;
}

std::uint32_t livox_crc32(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()),
                                              static_cast<z_size_t>(bytes.size())));
}

std::vector<std::byte> encode(const LivoxPacket& packet) {
  Bytes rest;
  put_little(rest, packet.stamp_ns, 8);
  if (packet.type == LivoxDataType::imu) {
    for (const float value : packet.rate_rad_s) put_float(rest, value);
    for (const float value : packet.acceleration_g) put_float(rest, value);
  }
  for (const LivoxPoint& point : packet.points) put_point(rest, point, packet.type);
  const bool is_imu = packet.type == LivoxDataType::imu;
  Bytes bytes;
  put_little(bytes, 0, 1);
  put_little(bytes, kStampAt + rest.size(), 2);
  put_little(bytes, packet.interval, 2);
  put_little(bytes, is_imu ? 1 : packet.points.size(), 2);
  put_little(bytes, packet.count, 2);
  put_little(bytes, packet.frame, 1);
  put_little(bytes, static_cast<std::uint8_t>(packet.type), 1);
  put_little(bytes, packet.time_type, 1);
  put_zeros(bytes, 12);
  put_little(bytes, livox_crc32(rest), 4);
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

LivoxPacket decode_livox_packet(std::span<const std::byte> payload) {
  check_head(payload);
  LivoxPacket packet;
  packet.interval = get<std::uint16_t>(payload, 3);
  packet.count = get<std::uint16_t>(payload, 7);
  packet.frame = get<std::uint8_t>(payload, 9);
  packet.type = static_cast<LivoxDataType>(get<std::uint8_t>(payload, 10));
  packet.time_type = get<std::uint8_t>(payload, 11);
  packet.stamp_ns = get<std::uint64_t>(payload, kStampAt);
  const std::size_t points = get<std::uint16_t>(payload, 5);
  const bool is_imu = packet.type == LivoxDataType::imu;
  const std::size_t size = is_imu ? kImuSample : livox_point_bytes(packet.type);
  if (points == 0 || (is_imu && points != 1) || payload.size() != kLivoxHead + points * size)
    fail_of_packet(
        std::to_string(points) + " points in " + std::to_string(payload.size()) + " bytes",
        "36 bytes and " + std::to_string(size) + " for each point");
  for (std::size_t i = 0; i < 3 && is_imu; ++i) {
    packet.rate_rad_s[i] = get_float(payload, kLivoxHead + 4 * i);
    packet.acceleration_g[i] = get_float(payload, kLivoxHead + 12 + 4 * i);
  }
  for (std::size_t i = 0; i < points && !is_imu; ++i)
    packet.points.push_back(get_point(payload.subspan(kLivoxHead + i * size, size), packet.type));
  return packet;
}

}  // namespace glidar
