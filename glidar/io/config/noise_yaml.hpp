// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/io/config/json_numbers.hpp>
#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/sensor/noise/noise.hpp>

#include <nlohmann/json.hpp>

#include <vector>

namespace glidar {

/// Reads a list of steps, each a map with the key 'type' and the numbers of its kind.
std::vector<NoiseStep> read_noise(const YamlField& field);

/// The list as the sidecar tells it, with every number, those by default too.
nlohmann::ordered_json noise_json(const std::vector<NoiseStep>& noise, InUnit convert = in_unit);

}  // namespace glidar
