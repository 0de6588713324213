// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/sensor/sensor.hpp>

#include <nlohmann/json.hpp>

namespace glidar {

/// Optics with the keys and units of a sensor file, which reads them back to the last bit; null for
/// a table of beams.
nlohmann::ordered_json optics_document(const Optics& optics);

}  // namespace glidar
