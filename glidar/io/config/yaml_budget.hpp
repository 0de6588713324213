// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <string>

namespace glidar {

/// Throws Error when a YAML text has too many values for memory: more than 1,000,000 as written
/// (yaml-cpp takes some 500 bytes for each), or, with its aliases expanded, more than 1,000,000 and
/// two for each byte; also when an alias is within the value that it repeats. Throws yaml-cpp's
/// exceptions when the text is no YAML.
void check_yaml_budget(const std::string& file, const std::string& text);

}  // namespace glidar
