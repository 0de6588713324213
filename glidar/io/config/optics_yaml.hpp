// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: the optics of sensor files, one function for each `type`.

#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/sensor.hpp>

namespace glidar {

Pinhole read_pinhole(const YamlField& field);
Spinning read_spinning(const YamlField& field);
LineScan read_line_scan(const YamlField& field);
Prism read_prism(const YamlField& field);
/// Beams from a file of rays or directions.
RayTable read_beam_table(const YamlField& field);
/// A spinning sensor from the metadata that Ouster sensors give of themselves.
Spinning read_ouster(const YamlField& field);

/// Every number of a list of 1 to `most`.
std::vector<double> numbers(const YamlField& field, const NumberRule& rule, std::size_t most);

}  // namespace glidar
