// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: YAML maps with overrides. Values keep their places in the file, for errors.

#include <glidar/io/config/yaml_reader.hpp>

#include <string>
#include <vector>

namespace glidar {

/// The base with overrides merged deeply over it: maps are merged key by key, scalars and lists are
/// replaced, null removes a key. Throws Error: either is no map, a key is given twice, or null for
/// a key that the base does not have.
YamlField merged(const YamlField& base, const YamlField& overrides);

/// The same map without these keys.
YamlField without_keys(const YamlField& map, const std::vector<std::string>& keys);

}  // namespace glidar
