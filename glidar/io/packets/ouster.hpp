// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/sensor/sensor.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
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
  /// RNG19_RFL8_SIG16_NIR16_RGB16: colour, of revision 8 (ouster-sdk 0.16.2, parsing.cpp)
  rng19_rfl8_sig16_nir16_rgb16,
  rng19_rfl8_sig16_nir16_rgb16_dual,  ///< RNG19_RFL8_SIG16_NIR16_RGB16_DUAL
};

/// The names as metadata spell them, in the order of OusterProfile.
std::span<const std::string_view> ouster_profile_names();
std::string_view name(OusterProfile profile);
/// Returns of a pixel: 1 or 2.
std::size_t ouster_returns(OusterProfile profile);
bool has_colour(OusterProfile profile);

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
  std::uint8_t window = 0;    ///< blocked window, only in RNG19 profiles without colour
  /// Red, green, blue, linear, 1 for white in the simulated light; only in RGB16 profiles, where
  /// both returns have one, in half precision.
  std::array<float, 3> colour{};
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

/// What an Ouster sensor states of itself.
struct OusterIdentity {
  std::uint32_t init_id = 1;  ///< 24 bits; packets of another one are not of this metadata
  std::uint64_t serial = 990'000'000'001;  ///< 40 bits
  std::string udp_destination = "127.0.0.1";
  std::uint16_t lidar_port = kOusterLidarPort;
  std::uint16_t imu_port = kOusterImuPort;
};

/// Options of Ouster packets. Without a profile: RNG19_RFL8_SIG16_NIR16 for one return, ..._DUAL
/// for two.
struct OusterOptions {
  std::optional<OusterProfile> profile;
  OusterIdentity identity;
  Pose sensor_from_imu = Pose::Identity();  ///< for the metadata
};

/// True if the sensor is named after an Ouster model, such as "Ouster OS1-128".
bool is_ouster(const Sensor& sensor);

/// Throws Error, naming the sensor, unless its columns and rate are a mode of Ouster sensors and
/// its rows and returns fit the profile.
std::unique_ptr<PacketEncoder> make_ouster_encoder(const Sensor& sensor,
                                                   const OusterOptions& options = {});

/// The metadata JSON that describes the sensor's packets, in the sections of firmware 2.4 and
/// later. The sensor's frame has its origin where the axis meets the plane of the beam origins, so
/// lidar_to_sensor_transform has no height. Throws Error like make_ouster_encoder.
std::string ouster_metadata(const Sensor& sensor, const OusterOptions& options = {});

/// A sensor as its metadata JSON describes it, of old or new firmware.
struct OusterSource {
  Sensor sensor;
  OusterFormat format;
  OusterIdentity identity;
};

/// Throws Error with the key that is missing or malformed.
OusterSource load_ouster_source(const std::filesystem::path& metadata);

/// The same from a text; `file` is where it comes from, for errors.
OusterSource parse_ouster_source(const std::string& text, const std::string& file);

/// Packets of another initialization_id are malformed, but one of 0 in the metadata fits all.
std::unique_ptr<PacketDecoder> make_ouster_decoder(const OusterSource& source);
/// Decodes the packets that make_ouster_encoder() makes of a sensor.
std::unique_ptr<PacketDecoder> make_ouster_decoder(const Sensor& sensor,
                                                   const OusterOptions& options = {});

}  // namespace glidar
