// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/sensor.hpp>

#include <string>
#include <vector>

namespace glidar {

/// All numbers of a sensor as a JSON text with the keys of a sensor file (docs/files.md):
/// parse_sensor() makes the same sensor from it, to the last bit. A sensor whose optics is a
/// RayTable has no `optics` in it, because a table can be large; pass the table to parse_sensor().
/// It has the sensor's notes, but not the sources of numbers and the names of the files that the
/// sensor was read from.
/// Throws Error naming the key when no number in the file's unit gives a number of the sensor.
std::string sensor_document(const Sensor& sensor);

/// A sentence for each number that no real sensor has, such as angles in radians or a reflectance
/// in percent: its key, its value, what is usual, and what it could be.
std::vector<std::string> implausible_numbers(const Sensor& sensor);

}  // namespace glidar
