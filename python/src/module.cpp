// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "bind.hpp"

#include <glidar/core/version.hpp>

NB_MODULE(_core, module) {
  module.doc() = "GLIDAR's library as glidar's modules use it; use those.";
  module.def("version", &glidar::version, "Its version, major.minor.patch.");
  glidar::python::bind_errors(module);
  glidar::python::bind_motion(module);
  glidar::python::bind_trajectory_state(module);
  glidar::python::bind_imu(module);
  glidar::python::bind_scene(module);
  glidar::python::bind_sensor(module);
  glidar::python::bind_frame(module);
  glidar::python::bind_output(module);
  glidar::python::bind_boxes(module);
  glidar::python::bind_simulator(module);
  glidar::python::bind_point_trace(module);
  glidar::python::bind_depth(module);
  glidar::python::bind_stereo(module);
  glidar::python::bind_tof(module);
  glidar::python::bind_structured_light(module);
  glidar::python::bind_tools(module);
  glidar::python::bind_yaml(module);
}
