// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// The entries of a frame that have a return, in the order of the points of a LAS file: by firing
/// time, then by pulse, then by range. Empty if it was not measured with these beams.
std::vector<std::uint32_t> las_order(const Frame& frame, const Beams& beams);

/// What a point record states of the scan.
struct LasScan {
  std::vector<std::int16_t> angles;  ///< scan angle in steps of 0.006 degrees
  std::vector<std::uint8_t> flags;   ///< bit 6: scan direction, bit 7: edge of flight line
};

/// Scan angles and flags of the entries `order` (LAS Specification 1.4 R15, table 15). The angle is
/// that of the beam as fired, around the direction of flight: 0 downwards, positive to the right.
/// Down is -z of the cloud; flight is along the sensor's motion in the frame, or, if it rests,
/// forward along the sensor. A scan line is a row of a line scanner or spinning sensor; the points
/// of its last pulse are its edge. Other sensors have no flags.
LasScan las_scan(const Frame& frame, const Beams& beams, const Sensor& sensor,
                 const Pose& world_from_cloud, std::span<const std::uint32_t> order);

}  // namespace glidar
