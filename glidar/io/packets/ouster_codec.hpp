// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/io/packets/ouster_packet.hpp>
#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace glidar {

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
