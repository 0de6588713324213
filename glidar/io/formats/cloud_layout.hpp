// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/sensor/sensor.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// The fields of a point as the driver of another sensor names, types, scales and orders them;
/// docs/files.md tells each field with its source.
struct PointFieldLayout {
  std::string name;
  std::string description;           ///< for --help: whose it is, and its fields
  std::vector<std::string> columns;  ///< cloud columns it is made of
};

/// All layouts, for help and errors.
std::span<const PointFieldLayout> cloud_layouts();

/// Throws Error naming all layouts and the nearest when there is none of this name.
const PointFieldLayout& find_layout(std::string_view name);

/// The points of a cloud, in the same order, with one column per field of the layout. The sensor
/// and its beams tell how its intensities are to be read.
/// Throws Error when there is no such layout or the cloud lacks a column that it is made of.
PointCloud apply_layout(const PointCloud& cloud, std::string_view layout, const Sensor& sensor,
                        const Beams& beams);

/// Intensities from 0 to 1, clipped, as KITTI's points have them. Of sensors of pulsed light the
/// calibrated reflectivity as the byte of the layout `velodyne` over 255; of sensors whose noise
/// spells intensity as a vendor's byte, that byte over 255; else the intensity itself. Needs the
/// columns intensity and, of pulsed light, range. Throws Error without them.
std::vector<float> unit_intensities(const PointCloud& cloud, const Sensor& sensor,
                                    const Beams& beams);

}  // namespace glidar
