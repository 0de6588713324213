// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/sensor/lidar/weather.hpp>

#include <nlohmann/json.hpp>

namespace glidar {

/// `weather` of a sensor file.
Weather read_weather(const YamlField& field);

/// As the sidecar tells it, with every number, those by default too.
nlohmann::ordered_json weather_json(const Weather& weather);

}  // namespace glidar
