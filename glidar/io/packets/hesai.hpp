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
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

inline constexpr std::uint16_t kHesaiPort = 2368;

/// The format of the packets of a Hesai model. Sources: user manuals of Pandar64, PandarQT and
/// PandarXT-32, "Point Cloud Data Packet"; block times as the driver tier4/nebula computes them.
struct HesaiModel {
  std::string_view name;  ///< that the sensor's name contains
  std::size_t channels = 0;
  std::size_t blocks = 0;
  std::size_t point_bytes = 0;  ///< 3, or 4 with a byte of confidence
  std::size_t head_bytes = 0;
  std::size_t tail_bytes = 0;             ///< with the sequence number
  std::array<std::uint8_t, 4> version{};  ///< bytes 0 to 3
  double block_period_ns = 0.0;
  double block_offset_ns = 0.0;   ///< start of the reference block after the packet's time
  bool counts_from_last = false;  ///< the reference is the last block, else the first
  std::uint8_t number = 0;        ///< by which the sensor states its model
};

/// A packet, number for number.
struct HesaiPacket {
  struct Point {
    std::uint16_t distance = 0;  ///< in 4 mm; 0: none
    std::uint8_t reflectivity = 0;
    std::uint8_t confidence = 0;  ///< only points of 4 bytes
  };
  struct Block {
    std::uint16_t azimuth = 0;  ///< 0.01 degrees, clockwise
    std::vector<Point> points;
  };
  std::vector<std::byte> head;
  std::vector<Block> blocks;
  std::vector<std::byte> tail;
};

/// The model of this sensor by its name; nullptr: none.
const HesaiModel* find_hesai_model(const Sensor& sensor);

/// Start of a firing sequence of a packet, nanoseconds after the time that the packet states.
double sequence_start_ns(const HesaiModel& model, std::size_t sequence, std::size_t sequences);

std::vector<std::byte> encode(const HesaiPacket& packet, const HesaiModel& model);
/// Throws Error for another size, or another head.
HesaiPacket decode_hesai_packet(std::span<const std::byte> payload, const HesaiModel& model);

/// Fields of the tail, whose places differ between models.
struct HesaiTail {
  std::uint8_t return_mode = 0x37;  ///< 0x37 strongest, 0x38 last, 0x39 both
  std::uint16_t motor_rpm = 600;
  std::int64_t stamp_ns = 0;  ///< since 1970; microseconds in the packet
  std::uint32_t sequence = 0;
};
std::vector<std::byte> encode(const HesaiTail& tail, const HesaiModel& model);
/// Throws Error when the time is no date.
HesaiTail decode_hesai_tail(std::span<const std::byte> tail, const HesaiModel& model);

/// True for sensors named after Pandar64, PandarQT or XT32.
bool is_hesai(const Sensor& sensor);

/// What a sensor states of itself to drivers.
struct HesaiIdentity {
  std::string angle_correction;  ///< CSV: Channel,Elevation,Azimuth in degrees, clockwise
  std::uint8_t model_number = 0;
  std::uint8_t channels = 0;
  std::uint8_t return_mode = 0;  ///< 0: last, 1: strongest, 2: both
  std::uint16_t spin_rate_rpm = 0;
};

/// Throws Error like make_hesai_encoder.
HesaiIdentity hesai_identity(const Sensor& sensor);

/// Throws Error, naming the sensor, when its channels or columns are not those of its model, or its
/// returns are not the strongest, the last, or both.
std::unique_ptr<PacketEncoder> make_hesai_encoder(const Sensor& sensor);

/// `follow_rotation`: the head turns on between a block's azimuth and a channel's firing. Hesai's
/// drivers do so only with a file of firing times. Throws Error like make_hesai_encoder.
std::unique_ptr<PacketDecoder> make_hesai_decoder(const Sensor& sensor,
                                                  bool follow_rotation = true);

}  // namespace glidar
