// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: where the numbers of a file come from, by its keys `source` and
// `unverified`.

#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/config/yaml_reader.hpp>

#include <vector>

namespace glidar {

/// All values of a file with their sources. Throws Error as the checks below do.
std::vector<DatasheetEntry> read_entries(const YamlField& root);

/// Each throws Error if a key that `source` or `unverified` names does not exist in the map.
void check_sources(const YamlField& map);
void check_unverified(const YamlField& map);

}  // namespace glidar
