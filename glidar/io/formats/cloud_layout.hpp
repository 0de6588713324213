// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// The point format of a sensor's driver: names, types, scales and order of the fields;
/// docs/files/layouts.md lists each field with its source.
struct PointFieldLayout {
  std::string name;
  std::string description;           ///< for --help: its driver and fields
  std::vector<std::string> columns;  ///< cloud columns that it requires
  /// Its driver's axes are those of the sensor turned by this many quarter turns about z: a point
  /// (x, y) of the sensor frame is (-y, x) after one.
  int quarter_turns = 0;
};

/// All layouts, for help and errors.
std::span<const PointFieldLayout> cloud_layouts();

/// Throws Error naming all layouts and the nearest when there is none of this name.
const PointFieldLayout& find_layout(std::string_view name);

/// The quarter turns of a layout's axes; 0 for the empty name, which means no layout.
int layout_turns(const std::string& layout);

/// Rotation from a sensor frame to one that is turned by quarter turns: (x, y) becomes (-y, x)
/// after one.
Pose quarter_turned(int turns);

/// The points of a cloud, in the same order, with one column per field of the layout. Sensor
/// and beams determine how intensities are converted. A cloud in the sensor frame gets the axes of
/// the driver.
/// Throws Error when there is no such layout or the cloud lacks a required column.
PointCloud apply_layout(const PointCloud& cloud, std::string_view layout, const Sensor& sensor,
                        const Beams& beams);

/// Intensities from 0 to 1, clipped, as in KITTI's points. For pulsed sensors the
/// calibrated reflectivity as the byte of the layout `velodyne` over 255; for sensors whose noise
/// converts intensity to a vendor's byte, that byte over 255; else the intensity itself. Needs the
/// columns intensity and, for pulsed sensors, range. Throws Error without them.
std::vector<float> unit_intensities(const PointCloud& cloud, const Sensor& sensor,
                                    const Beams& beams);

/// Reflectivities as the layout `livox` has them. Needs the columns intensity and range. Throws
/// Error without them.
std::vector<std::uint8_t> livox_reflectivities(const PointCloud& cloud, const Sensor& sensor,
                                               const Beams& beams);

}  // namespace glidar
