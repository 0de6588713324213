// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/noise/noise.hpp>

#include <string>

namespace glidar {

/// A step of noise as its name and numbers in a sensor file: "range_gaussian sigma_m 0.03,
/// sigma_per_m 0".
std::string noise_text(const NoiseStep& step);

}  // namespace glidar
