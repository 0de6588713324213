// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar::ros {

/// The order of points. A column is what a scanner fires at one azimuth, once for each return.
enum class PointOrder : std::uint8_t {
  firing,       ///< by firing time, stably; one row
  rows,         ///< as the beams: height = channels; one row without misses
  destaggered,  ///< the same, each row shifted so that columns have one azimuth (Ouster)
  columns,      ///< height = columns, width = channels in the order of the beams
  rings,        ///< the same, channels by their ring
};

/// The columns that a scanner's driver receives in one packet: those of the maker's format, or
/// about 384 points.
std::size_t columns_per_packet(const Sensor& sensor, const Beams& beams);

/// The time that such a packet states, ns after its first firing; 0 for other makers' packets.
std::int64_t packet_time_offset_ns(const Sensor& sensor, const Beams& beams);

/// The columns by which the rows of an Ouster's images are shifted: pixel_shift_by_row.
std::vector<std::size_t> row_shifts(const Sensor& sensor, const Beams& beams);

/// The entries of the beams of a grid in an order other than PointOrder::firing and rows.
std::vector<std::uint32_t> ordered_entries(const Sensor& sensor, const Beams& beams,
                                           PointOrder order);

}  // namespace glidar::ros
