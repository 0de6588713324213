// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: which returns packets contain, and in which order.

#include <glidar/io/packets/firing_sequence.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace glidar {

/// Return mode of Velodyne's and Hesai's packets (VLP-16 User Manual 63-9243, 9.3.1.6).
enum class PacketReturnMode : std::uint8_t { strongest = 0x37, last = 0x38, dual = 0x39 };

/// The returns of a sensor.
struct ReturnSelection {
  PacketReturnMode mode = PacketReturnMode::strongest;
  std::size_t strongest = 0;  ///< index in Receiver::returns
  std::size_t last = 0;

  [[nodiscard]] bool is_dual() const { return mode == PacketReturnMode::dual; }
};

/// Throws Error, with the packets' name, unless the sensor reports the strongest, the last, or
/// both.
ReturnSelection select_packet_returns(const Sensor& sensor, const std::string& packets);

struct LastAndStrongest {
  PacketReturn last;
  PacketReturn strongest;
};

/// The two returns of a laser. The farther is the last; sensors repeat a single one in both places,
/// and give the second strongest if the last is the strongest (VLP-16 User Manual, 6.2.3).
LastAndStrongest last_and_strongest(const FiringSequence& sequence, std::size_t lasers,
                                    std::size_t laser);

/// The inverse: stores the two returns of a laser; a repeated one once.
void store_returns(const LastAndStrongest& found, const ReturnSelection& selection,
                   std::size_t lasers, std::size_t laser, FiringSequence& sequence);

}  // namespace glidar
