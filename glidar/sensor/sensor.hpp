// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/light.hpp>
#include <glidar/sensor/pinhole.hpp>

#include <limits>
#include <string>
#include <variant>

namespace glidar {

using Optics = std::variant<Pinhole>;

/// Depths that the sensor can report, along the boresight. A surface outside still blocks the beam.
struct DepthLimits {
  double near_m = 0.0;
  double far_m = std::numeric_limits<double>::infinity();
};

/// A 3D sensor, as plain numbers.
struct Sensor {
  std::string name = "depth camera";
  Optics optics = Pinhole{};
  DepthLimits limits;
  Light light;
  bool cull_back_faces = false;  ///< true: triangles seen from behind let the beam through
};

/// What the sensor emits, in its own frame.
Beams make_beams(const Sensor& sensor);

}  // namespace glidar
