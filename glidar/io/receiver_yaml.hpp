// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/yaml_reader.hpp>
#include <glidar/sensor/echo.hpp>
#include <glidar/sensor/footprint.hpp>

#include <string>

namespace glidar {

/// `footprint` of a sensor file: divergence_mrad and exit_mm are one number, or [across, up];
/// `widths` tells whether they are full widths at 1/e^2 (as kept) or at half maximum; `rings` of
/// sub-rays.
Footprint read_footprint(const YamlField& field);

/// `receiver` of a sensor file: pulse_ns (full width at half maximum), timing, separation_m,
/// returns.
Receiver read_receiver(const YamlField& field);

/// The word for a return: "first", "second", "last", "strongest", ...
std::string return_name(const Return& one);

}  // namespace glidar
