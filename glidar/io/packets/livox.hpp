// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/sensor/sensor.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace glidar {

// UDP ports of the Mid-360 (Livox SDK 2, sdk_core/comm/define.h): of the host, and of the sensor.
inline constexpr std::uint16_t kLivoxPointPort = 56301;
inline constexpr std::uint16_t kLivoxImuPort = 56401;
inline constexpr std::uint16_t kLivoxPointSourcePort = 56300;
inline constexpr std::uint16_t kLivoxImuSourcePort = 56400;

/// Points of a packet of a real sensor.
inline constexpr std::size_t kLivoxPoints = 96;

/// Format of a packet's data (Livox SDK 2, livox_lidar_def.h).
enum class LivoxDataType : std::uint8_t {
  imu = 0,           ///< one sample
  cartesian_mm = 1,  ///< x y z, 32 bits each
  cartesian_cm = 2,  ///< x y z, 16 bits each
  spherical = 3,     ///< depth in mm; zenith angle and azimuth in 0.01 degrees
};

struct LivoxPoint {
  /// x, y and z; of spherical points the depth, the zenith angle and the azimuth. All 0: no return.
  std::array<std::int64_t, 3> numbers{};
  std::uint8_t reflectivity = 0;
  std::uint8_t tag = 0;
};

/// A packet, number for number.
struct LivoxPacket {
  std::uint16_t interval = 0;  ///< 0.1 us, from the first point to the first of the next packet
  std::uint16_t count = 0;     ///< of packets, in a frame
  std::uint8_t frame = 0;
  LivoxDataType type = LivoxDataType::cartesian_mm;
  std::uint8_t time_type = 1;  ///< 0: not synchronised, 1: PTP, 2: GPS
  std::uint64_t stamp_ns = 0;  ///< of the first point
  std::vector<LivoxPoint> points;
  std::array<float, 3> rate_rad_s{};      ///< only imu
  std::array<float, 3> acceleration_g{};  ///< only imu: specific force, 1 g upwards at rest
};

/// Whether the numbers fit the bits of the type.
bool fits(const LivoxPoint& point, LivoxDataType type);

/// The payload. Numbers must fit.
std::vector<std::byte> encode(const LivoxPacket& packet);
/// Throws Error for another version, length or type, and a wrong checksum.
LivoxPacket decode_livox_packet(std::span<const std::byte> payload);

/// CRC-32 of IEEE 802.3, as all of Livox's protocols have it.
std::uint32_t livox_crc32(std::span<const std::byte> bytes);

/// True for sensors with rotating prisms whose name begins with "Livox".
bool is_livox(const Sensor& sensor);

/// The packets of Livox SDK 2, of Mid-360 and HAP. Points are in the order of firing, with zeros
/// for beams without a return and for points beyond the numbers of the type. Throws Error, naming
/// the sensor, when it reports several returns or its beams do not divide a packet, and for imu.
std::unique_ptr<PacketEncoder> make_livox_encoder(const Sensor& sensor,
                                                  LivoxDataType type = LivoxDataType::cartesian_mm);

/// Decodes all types. A frame has the points of 1 / Sensor::rate_hz; beams without a return have no
/// direction. Throws Error like make_livox_encoder.
std::unique_ptr<PacketDecoder> make_livox_decoder(const Sensor& sensor);

}  // namespace glidar
