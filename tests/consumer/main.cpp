// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/glidar.hpp>

#include <cmath>
#include <cstdio>

/// Looks at the sphere of radius 1 m from 3 m: the middle beam must measure 2 m.
int main() {
  glidar::Scene scene;
  glidar::add_model(scene, glidar::make_builtin_model("sphere"));
  glidar::Sensor sensor;
  sensor.optics = glidar::pinhole_from_fov(65, 65, 0.5);
  glidar::Simulator simulator(scene, sensor);
  const glidar::Frame frame =
      simulator.simulate(glidar::look_at({3.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}));

  const double middle_m = frame.range_m.at(frame.range_m.size() / 2);
  std::printf("range of the middle beam: %.6f m\n", middle_m);
  const double facet_error_m = 1e-3;  // flat triangles lie inside the round sphere
  return std::abs(middle_m - 2.0) < facet_error_m ? 0 : 1;
}
