// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace glidar {

inline constexpr std::uint16_t kOusterLidarPort = 7502;
inline constexpr std::uint16_t kOusterImuPort = 7503;

/// Format of a pixel (Ouster firmware manual, "Lidar Data Packet Format").
enum class OusterProfile : std::uint8_t {
  legacy,                       ///< LEGACY: 20 bits of range
  rng19_rfl8_sig16_nir16,       ///< RNG19_RFL8_SIG16_NIR16
  rng19_rfl8_sig16_nir16_dual,  ///< RNG19_RFL8_SIG16_NIR16_DUAL: two returns
  rng15_rfl8_nir8,              ///< RNG15_RFL8_NIR8: low data rate, ranges in 8 mm
};

/// The names as metadata spell them, in the order of OusterProfile.
std::span<const std::string_view> ouster_profile_names();
std::string_view name(OusterProfile profile);
/// Returns of a pixel: 1 or 2.
std::size_t ouster_returns(OusterProfile profile);

struct OusterFormat {
  OusterProfile profile = OusterProfile::rng19_rfl8_sig16_nir16;
  std::size_t rows = 128;
  std::size_t columns_per_packet = 16;
  std::vector<std::size_t> slots = {};  ///< row of each channel; empty: all rows in order
};

/// Bytes of a lidar packet.
std::size_t ouster_packet_bytes(const OusterFormat& format);

/// One return of a pixel. Values are limited to the bits of the profile.
struct OusterPixel {
  std::uint32_t range_mm = 0;  ///< 0: none; a multiple of 8 in RNG15_RFL8_NIR8
  std::uint8_t flags = 0;
  std::uint8_t reflectivity = 0;
  std::uint16_t signal = 0;   ///< photons; not in RNG15_RFL8_NIR8
  std::uint16_t near_ir = 0;  ///< a multiple of 16 in RNG15_RFL8_NIR8
  std::uint8_t window = 0;    ///< blocked window, only in RNG19 profiles
};

struct OusterColumn {
  std::uint64_t stamp_ns = 0;
  std::uint16_t measurement = 0;  ///< number of the column in the revolution
  bool is_valid = false;
  std::vector<OusterPixel> pixels;  ///< returns x rows, the top row first
};

struct OusterPacket {
  std::uint16_t frame = 0;
  std::uint32_t init_id = 0;  ///< 24 bits, equal to that of the metadata; not in LEGACY
  std::uint64_t serial = 0;   ///< 40 bits; not in LEGACY
  std::uint8_t alert = 0;
  std::array<std::byte, 19> status{};  ///< bytes 13 to 31 of the header, as they are
  std::array<std::byte, 24> footer{};  ///< before the checksum, as they are
  bool has_crc = true;                 ///< false: firmware without checksum
  std::uint64_t mark = 0;              ///< in place of the checksum
  std::vector<OusterColumn> columns;
};

/// The payload; `columns_per_turn` scales the encoder count of LEGACY. Throws Error when columns or
/// pixels do not have the format's number.
std::vector<std::byte> encode(const OusterPacket& packet, const OusterFormat& format,
                              std::uint32_t columns_per_turn);

/// Throws Error for another size or type, or a wrong checksum.
OusterPacket decode_ouster_packet(std::span<const std::byte> payload, const OusterFormat& format);

/// CRC-64 of Ouster packets: the polynomial of ECMA-182, reflected.
std::uint64_t crc64(std::span<const std::byte> bytes);

/// An IMU packet of the profile LEGACY, port 7503.
struct OusterImu {
  std::uint64_t stamp_ns = 0;
  std::uint64_t acceleration_stamp_ns = 0;
  std::uint64_t rate_stamp_ns = 0;
  std::array<float, 3> acceleration_g{};  ///< specific force: 1 g upwards at rest
  std::array<float, 3> rate_deg_s{};
};

inline constexpr std::size_t kOusterImuBytes = 48;

std::vector<std::byte> encode(const OusterImu& imu);
/// Throws Error for another size.
OusterImu decode_ouster_imu(std::span<const std::byte> payload);

}  // namespace glidar
