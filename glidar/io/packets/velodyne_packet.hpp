// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glidar {

inline constexpr std::size_t kVelodyneBlocks = 12;
inline constexpr std::size_t kVelodyneBlockPoints = 32;
inline constexpr std::size_t kVelodynePacketBytes = 1206;
inline constexpr std::size_t kVelodynePositionBytes = 512;
inline constexpr std::uint16_t kVelodynePort = 2368;
inline constexpr std::uint16_t kVelodynePositionPort = 8308;

/// A data packet, number for number (VLP-16 User Manual 63-9243, 9.3).
struct VelodynePacket {
  struct Block {
    std::uint16_t flag = 0;     ///< bank of 32 lasers: 0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF
    std::uint16_t azimuth = 0;  ///< 0.01 degrees, clockwise
    std::array<std::uint16_t, kVelodyneBlockPoints> distance{};  ///< in units of the model; 0: none
    std::array<std::uint8_t, kVelodyneBlockPoints> reflectivity{};
  };
  std::array<Block, kVelodyneBlocks> blocks{};
  std::uint32_t hour_us = 0;  ///< microseconds since the full hour, truncated
  std::uint8_t mode = 0;      ///< 0x37 strongest, 0x38 last, 0x39 both; HDL-64E: type of status
  std::uint8_t model = 0;     ///< factory byte; HDL-64E: value of status
};

std::vector<std::byte> encode(const VelodynePacket& packet);

/// Throws Error unless the payload has the size of a data packet.
VelodynePacket decode_velodyne_packet(std::span<const std::byte> payload);

/// A position packet (VLP-16 User Manual 63-9243, 9.4), port 8308.
struct VelodynePosition {
  std::uint32_t hour_us = 0;
  std::uint8_t pps_state = 0;  ///< 0 absent, 2 locked
  std::string nmea;            ///< one sentence $GPRMC with checksum, without line end
};

/// Throws Error when the sentence does not fit.
std::vector<std::byte> encode(const VelodynePosition& position);

/// Throws Error for another size.
VelodynePosition decode_velodyne_position(std::span<const std::byte> payload);

/// A sentence $GPRMC (NMEA 0183) for a time since 1970 and a position in degrees, north and east;
/// status A with `has_fix`, else V.
std::string nmea_rmc(std::int64_t stamp_ns, double latitude_deg, double longitude_deg,
                     bool has_fix);

/// Microseconds since the full hour of a time since 1970, truncated.
std::uint32_t hour_us(std::int64_t stamp_ns);

/// The time whose microseconds since the full hour are given and that is nearest to `near_ns`.
std::int64_t stamp_in_hour(std::uint32_t hour_us, std::int64_t near_ns);

}  // namespace glidar
