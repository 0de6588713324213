// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/sensor.hpp>
#include <simulate/panels.hpp>
#include <support/simulate.hpp>

namespace glidar::testing {

inline constexpr HitColumnMask kVelocityTruth = {.object_point = true, .radial_velocity = true};

/// A sensor that looks along z, at panels; all may move.
struct VelocityStage : PanelScene {
  Sensor sensor;
  Motion motion;
  unsigned threads = 2;

  VelocityStage() {
    sensor.name = "fmcw";
    sensor.optics = pinhole_from_fov(16, 12, 0.6);
    sensor.doppler = Doppler{};
  }
  /// Pulses with a footprint.
  void spread(double divergence_rad) {
    sensor.lidar_equation = LidarEquation{.reference_reflectance = 0.01, .reference_range_m = 1e4};
    sensor.footprint = Footprint{
        .divergence_x_rad = divergence_rad, .divergence_y_rad = divergence_rad, .rings = 2};
  }
  [[nodiscard]] Frame shoot(const Beams& beams,
                            const HitColumnMask& hit_columns = kVelocityTruth) const {
    const auto renderer = make_renderer(scene, {.threads = threads});
    Frame frame;
    frame.seed = 3;
    testing::simulate({scene, sensor, beams, motion, *renderer}, hit_columns, frame);
    return frame;
  }
  [[nodiscard]] Frame shoot() const { return shoot(make_beams(sensor)); }
};

/// One beam along z.
inline VelocityStage single_beam() {
  VelocityStage stage;
  RayTable one;
  one.rows = 1;
  one.cols = 1;
  one.directions = {Eigen::Vector3d::UnitZ()};
  stage.sensor.optics = one;
  return stage;
}

}  // namespace glidar::testing
