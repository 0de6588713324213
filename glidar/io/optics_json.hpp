// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/sensor/sensor.hpp>

#include <nlohmann/json.hpp>

namespace glidar {

/// Optics as sidecar files tell them, in the units of sensor files. Keys stay in this order.
nlohmann::ordered_json optics_json(const Optics& optics);

}  // namespace glidar
