// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/prepared_tof.hpp>

#include <glidar/sensor/optics/pinhole.hpp>

#include <cmath>

namespace glidar {
namespace {

/// The decoder knows depths, or ranges as depths, as the sensor's limits do.
void find_directions(const Sensor& sensor, PreparedTof& prepared) {
  const Beams pixels = make_beams(sensor);
  const bool is_depth = sensor.limits.along == Limits::Along::depth;
  prepared.depth_per_range.reserve(pixels.size());
  prepared.is_illuminated.reserve(pixels.size());
  for (const Eigen::Vector3d& direction : pixels.directions) {
    const bool has_ray = !std::isnan(direction.x());
    const double cosine = is_depth && has_ray ? direction.dot(pixels.boresight) : 1.0;
    prepared.depth_per_range.push_back(static_cast<float>(cosine));
    prepared.is_illuminated.push_back(has_ray ? 1 : 0);
  }
}

}  // namespace

PreparedTof prepare_tof(const TofCamera& camera, const Sensor& sensor) {
  PreparedTof prepared{
      .camera = camera,
      .decoder = camera.decoder,
      .steps = make_tof_steps(camera),
      .wavelength_m = sensor.wavelength_m,
      .rays = make_beams(divide_pixels(std::get<Pinhole>(sensor.optics), camera.sub_rays))};
  prepared.decoder.near_m = sensor.limits.near_m;
  prepared.decoder.far_m = sensor.limits.far_m;
  find_directions(sensor, prepared);
  return prepared;
}

}  // namespace glidar
