// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/hdl64_status.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>

namespace glidar {
namespace {

constexpr std::size_t kGroupPackets = 16;
constexpr std::string_view kStateTypes = "HMSDNYGTV";
constexpr std::size_t kGroupValues = kGroupPackets - kStateTypes.size();
constexpr std::string_view kMark = "UNIT#";
constexpr std::size_t kFirstLaser = kGroupValues;
constexpr std::size_t kLaserValues = 28;
constexpr std::size_t kLasers = 64;
constexpr std::size_t kParameters = kFirstLaser + kLasers * kLaserValues - kGroupValues;
// What a simulation has no values for: those of the manual's examples.
constexpr std::uint8_t kThreshold = 24;
constexpr std::uint8_t kTemperature = 27;  // degrees Celsius
constexpr std::uint8_t kFirmware = 0x47;
constexpr std::uint8_t kHasSync = 'P';
constexpr std::uint8_t kAutomaticPower = 0xA8;
constexpr std::array<std::uint8_t, 6> kCalibrationTime = {13, 1, 1, 0, 0, 0};
constexpr std::array<std::uint8_t, 8> kAddresses = {192, 168, 3, 43, 192, 168, 3, 255};

/// CRC-16 with the polynomial 8005, the highest bit first.
std::uint16_t add_crc(std::uint16_t crc, std::uint8_t byte) {
  constexpr std::uint32_t kPolynomial = 0x8005;
  std::uint32_t rest = crc ^ (std::uint32_t{byte} << 8U);
  for (int bit = 0; bit < 8; ++bit)
    rest = (rest << 1U) ^ ((rest & 0x8000U) != 0 ? kPolynomial : 0U);
  return static_cast<std::uint16_t>(rest);
}

/// The type of a value: its number in the group, except for those that the manual's table names.
std::uint8_t value_type(std::size_t index) {
  constexpr std::array<std::uint8_t, 6> kSpeedAndView = {0xFE, 0xFF, 0xFC, 0xFD, 0xFA, 0xFB};
  constexpr std::size_t kSpeed = kParameters + kGroupValues;
  constexpr std::size_t kReturns = kParameters + 3 * kGroupValues + 2;
  if (index >= kSpeed && index < kSpeed + kSpeedAndView.size())
    return kSpeedAndView[index - kSpeed];
  if (index == kReturns) return 0xF9;
  if (index == kReturns + 2) return 0xF8;
  const bool is_laser = index >= kFirstLaser && index < kParameters;
  if (is_laser && (index - kFirstLaser) % kLaserValues == 3 * kGroupValues) return 'W';
  return static_cast<std::uint8_t>('1' + index % kGroupValues);
}

}  // namespace

Hdl64Status::Hdl64Status(const Spinning& spinning, PacketReturnMode mode, bool has_position)
    : has_position_(has_position) {
  std::copy(kMark.begin(), kMark.end(), values_.begin());
  values_[kMark.size()] = values_[kMark.size() + 1] = kThreshold;
  std::uint16_t crc = 0;
  for (std::size_t laser = 0; laser < std::min(kLasers, spinning.channels.size()); ++laser) {
    put_laser(laser, spinning.channels[laser]);
    const std::size_t first = kFirstLaser + laser * kLaserValues;
    for (std::size_t i = 1; i <= 20; ++i) crc = add_crc(crc, values_[first + i]);
  }
  std::copy(kCalibrationTime.begin(), kCalibrationTime.end(), values_.begin() + kParameters);
  constexpr std::size_t kSpeed = kParameters + kGroupValues;
  put_number(kSpeed, 60.0 * spinning.rotation_hz);
  put_number(kSpeed + 4, 36'000.0);  // the view begins at 0
  std::copy(kAddresses.begin(), kAddresses.end(), values_.begin() + kSpeed + 8);
  constexpr std::size_t kReturns = kSpeed + 16;
  values_[kReturns] = static_cast<std::uint8_t>(static_cast<int>(mode) -
                                                static_cast<int>(PacketReturnMode::strongest));
  values_[kReturns + 2] = kAutomaticPower;
  put_number(kValues - 2, crc);
}

/// Little-endian, limited to its range; negative numbers as two's complement.
void Hdl64Status::put_number(std::size_t at, double number, int bytes) {
  const long rounded = std::lround(std::clamp(number, -32'768.0, 65'535.0));
  const auto bits = static_cast<std::uint32_t>(rounded);
  for (int i = 0; i < bytes; ++i) {
    const auto shift = static_cast<unsigned>(8 * i);
    values_[at + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(bits >> shift);
  }
}

/// Angles, and the offsets across the beam that move its origin: the height turns with the beam.
/// The correction of distances is the same near and far, and intensities have the whole range of a
/// byte.
void Hdl64Status::put_laser(std::size_t laser, const SpinningChannel& channel) {
  constexpr double kCentidegree_rad = 0.01 * kDegree;
  const std::size_t at = kFirstLaser + laser * kLaserValues;
  const double elevation = channel.elevation_rad;
  const double height_m = channel.origin_m.z() * portable_cos(elevation) -
                          channel.origin_m.x() * portable_sin(elevation);
  values_[at] = static_cast<std::uint8_t>(laser);
  put_number(at + 1, elevation / kCentidegree_rad);
  put_number(at + 3, channel.azimuth_offset_rad / kCentidegree_rad);
  for (const std::size_t correction : {at + 5, at + 7, at + 9})
    put_number(correction, channel.distance_correction_m / kMillimetre_m);
  put_number(at + 11, height_m / kMillimetre_m);
  put_number(at + 13, channel.origin_m.y() / kMillimetre_m);
  put_number(at + 20, 255.0, 1);
}

std::uint8_t Hdl64Status::unit_state(std::size_t index, std::int64_t stamp_ns) const {
  using std::chrono::days;
  const std::chrono::sys_time<std::chrono::nanoseconds> time{std::chrono::nanoseconds(stamp_ns)};
  const auto day = std::chrono::floor<days>(time);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss clock{std::chrono::floor<std::chrono::seconds>(time) - day};
  const std::array<std::uint8_t, kStateTypes.size()> state = {
      static_cast<std::uint8_t>(clock.hours().count()),
      static_cast<std::uint8_t>(clock.minutes().count()),
      static_cast<std::uint8_t>(clock.seconds().count()),
      static_cast<std::uint8_t>(static_cast<unsigned>(date.day())),
      static_cast<std::uint8_t>(static_cast<unsigned>(date.month())),
      static_cast<std::uint8_t>(static_cast<int>(date.year()) % 100),
      has_position_ ? kHasSync : std::uint8_t{0},
      kTemperature,
      kFirmware};
  return state[index];
}

Hdl64Status::Entry Hdl64Status::at(std::uint64_t packet, std::int64_t stamp_ns) const {
  const std::size_t in_cycle = packet % kCycle;
  const std::size_t in_group = in_cycle % kGroupPackets;
  if (in_group < kStateTypes.size())
    return {static_cast<std::uint8_t>(kStateTypes[in_group]), unit_state(in_group, stamp_ns)};
  const std::size_t index = in_cycle / kGroupPackets * kGroupValues + in_group - kStateTypes.size();
  return {value_type(index), values_[index]};
}

}  // namespace glidar
