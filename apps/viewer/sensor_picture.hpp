// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/viewer/cloud_drawing.hpp>
#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/io/pictures/beam_picture.hpp>
#include <glidar/io/pictures/chart.hpp>
#include <glidar/io/pictures/colour_scale.hpp>

#include <array>
#include <string_view>
#include <vector>

namespace glidar::app {

/// The displayed quantity of a measurement.
enum class Quantity : std::uint8_t { depth, range, intensity, normals, instance, status };
inline constexpr std::array<std::string_view, 6> kQuantities = {"depth",   "range",    "intensity",
                                                                "normals", "instance", "status"};

/// A measurement as colours, one per beam, with their meaning.
struct SensorPicture {
  std::vector<Colour> colours;      ///< rows x cols, row by row
  BeamPicture layout;               ///< where each beam is shown; all returns, one below the other
  ColourScale scale;                ///< of the quantities that have one
  std::vector<LegendEntry> legend;  ///< of the others
};

/// Beams without a return are grey, near ones bright. Normals are in the sensor's view: red right,
/// green up, blue towards the sensor; they need frame.ground_truth.normal.
void make_sensor_picture(const Frame& frame, const Beams& beams, const Scene& scene,
                         Quantity quantity, ColourMap map, SensorPicture& picture);

/// True for quantities with a colour map and a scale.
bool has_scale(Quantity quantity);

/// The unit of the scale: "m", or empty.
std::string_view unit_of(Quantity quantity);

/// The colour of a status.
Colour colour_of(Status status);

}  // namespace glidar::app
