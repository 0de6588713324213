// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: the last two bytes of the packets of an HDL-64E.

#include <glidar/io/packets/return_selection.hpp>
#include <glidar/sensor/optics/spinning.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace glidar {

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

}  // namespace glidar
