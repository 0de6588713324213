// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/sensor/lidar/echo.hpp>
#include <glidar/sensor/lidar/footprint.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// `footprint` of a sensor file: divergence_mrad and exit_mm are one number, or [across, up];
/// `width_definition` tells whether they are full widths at 1/e^2 (as kept) or at half maximum;
/// `rings` of sub-rays.
Footprint read_footprint(const YamlField& field);

/// `receiver` of a sensor file: pulse_ns (full width at half maximum), timing, separation_m,
/// returns.
Receiver read_receiver(const YamlField& field);

/// The words for returns: "first", "second", "last", "strongest", ...
std::vector<std::string> return_names();

/// The return that one of them stands for.
Return return_named(std::string_view name);

/// The `count` nearest returns.
std::vector<Return> nearest_returns(std::uint32_t count);

/// The word for a return, or "return 4" and so on of the nearest.
std::string return_name(const Return& one);

}  // namespace glidar
