// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/sensor/optics/spinning.hpp>
#include <glidar/sensor/sensor.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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

struct VelodyneModel {
  std::string_view name;  ///< that the sensor's name contains
  std::size_t lasers = 0;
  double unit_m = 0.0;
  double period_ns = 0.0;       ///< of firing sequences
  double dual_period_ns = 0.0;  ///< with two returns
  /// Time of a laser since the start of its sequence.
  double (*fire_time_ns)(std::size_t laser, bool is_dual) = nullptr;
  std::uint8_t factory_byte = 0;  ///< 0: the packet has a status byte there
  double stamp_offset_ns = 0.0;   ///< of the packet's time after the start of its first sequence
};

/// How a sensor's firings fill packets.
struct VelodyneLayout {
  VelodyneModel model;
  ReturnSelection returns;
  std::size_t sequences = 0;  ///< per packet

  [[nodiscard]] bool is_dual() const { return returns.is_dual(); }
  [[nodiscard]] double period_ns() const {
    return is_dual() ? model.dual_period_ns : model.period_ns;
  }
};

/// The place of a point in a packet.
struct VelodyneSlot {
  std::size_t block = 0;
  std::size_t point = 0;
};

/// The model that the sensor's name contains; nullptr: none.
const VelodyneModel* find_velodyne_model(const Sensor& sensor);

/// Throws Error, naming the sensor, when its firings are not those of its model.
VelodyneLayout velodyne_layout(const Sensor& sensor);

/// Place of a laser of a sequence of the packet; `is_last` selects the block if it is dual.
VelodyneSlot velodyne_slot(const VelodyneLayout& layout, std::size_t sequence, std::size_t laser,
                           bool is_last);

/// Bank of 32 lasers that a block contains, from 0.
std::size_t velodyne_bank(const VelodyneLayout& layout, std::size_t block);

/// The status of an HDL-64E S3, one type and value per packet (HDL-64E S3 User's Manual
/// 63-HDL64ES3, appendix E). Groups of 16 packets have the date, time and state of the unit and
/// seven values of its calibration, which is complete after 260 groups.
class Hdl64Status {
 public:
  struct Entry {
    std::uint8_t type = 0;
    std::uint8_t value = 0;
  };

  /// The calibration of these 64 lasers, in centidegrees and millimetres.
  Hdl64Status(const Spinning& spinning, PacketReturnMode mode, bool has_position);

  /// The entry of a packet, counted from the start of the recording, at a time since 1970.
  [[nodiscard]] Entry at(std::uint64_t packet, std::int64_t stamp_ns) const;

  static constexpr std::uint64_t kCycle = 4160;  ///< packets

 private:
  static constexpr std::size_t kValues = 1820;

  void put_number(std::size_t at, double number, int bytes = 2);
  void put_laser(std::size_t laser, const SpinningChannel& channel);
  [[nodiscard]] std::uint8_t unit_state(std::size_t index, std::int64_t stamp_ns) const;

  std::array<std::uint8_t, kValues> values_{};
  bool has_position_ = false;
};

/// Position for position packets, degrees north and east. Without it they state no fix.
struct GeoPosition {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
};

/// True if the sensor is named after a Velodyne model: VLP-16, Puck Hi-Res, VLP-32C, HDL-32E,
/// HDL-64E S3 or VLS-128.
bool is_velodyne(const Sensor& sensor);

/// Data packets (port 2368) and position packets (port 8308). Throws Error, naming the sensor, when
/// its lasers do not fire as those of its model do, or its returns are not the strongest, the last,
/// or both.
std::unique_ptr<PacketEncoder> make_velodyne_encoder(
    const Sensor& sensor, const std::optional<GeoPosition>& position = {});

/// Angles come from the sensor, the hour from the time of capture. The intensity is the packets'
/// byte. Throws Error like make_velodyne_encoder.
std::unique_ptr<PacketDecoder> make_velodyne_decoder(const Sensor& sensor);

}  // namespace glidar
