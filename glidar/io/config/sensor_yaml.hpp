// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/sensor/sensor.hpp>

namespace glidar {

/// The sensor that a YAML map describes, a file of its own or a part of a scene file.
Sensor read_sensor(const YamlField& field);

}  // namespace glidar
