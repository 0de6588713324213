// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: how the Velodyne models order and time their firings.

#include <glidar/io/packets/return_selection.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace glidar {

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

}  // namespace glidar
