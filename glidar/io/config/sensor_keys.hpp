// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: a sensor as files have it.

#include <glidar/io/config/optics_keys.hpp>

namespace glidar {

struct SensorKeys {
  Sensor sensor;  ///< its optics are set by readers only
  OpticsKeys optics;
  bool has_table = false;  ///< the sensor's optics are a RayTable, given beside the file
};

/// The keys of a sensor, for writers.
SensorKeys sensor_keys(const Sensor& sensor);

void describe(SensorKeys& keys, FieldVisitor& visitor);

}  // namespace glidar
