// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: how numbers are written into JSON files.

#include <nlohmann/json.hpp>

namespace glidar {

/// Writes 0.0 for every -0.0 in the document.
void remove_negative_zeros(nlohmann::ordered_json& json);

}  // namespace glidar
