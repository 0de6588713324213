// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/depth_camera/time_of_flight.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar {

/// A time-of-flight camera with everything that is the same for all frames. P = number of pixels.
struct PreparedTof {
  const TofCamera& camera;
  TofOptions decoder;  ///< with the limits of the sensor
  TofSteps steps;
  double wavelength_m = 0.0;
  Beams rays;                               ///< sub_rays x sub_rays for each pixel, row by row
  std::vector<float> depth_per_range = {};  ///< P, cosine to the boresight
  std::vector<std::uint8_t> is_illuminated = {};  ///< P, 0: the optics have no ray for the pixel
};

PreparedTof prepare_tof(const TofCamera& camera, const Sensor& sensor);

/// Phase steps of all frequencies.
inline std::size_t step_count(const PreparedTof& prepared) {
  return prepared.steps.frequencies * prepared.steps.taps;
}

}  // namespace glidar
