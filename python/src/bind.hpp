// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

namespace glidar::python {

namespace nb = nanobind;

// One function per file, which defines its Python bindings.
void bind_errors(nb::module_& module);
void bind_motion(nb::module_& module);
void bind_scene(nb::module_& module);
void bind_sensor(nb::module_& module);
void bind_imu(nb::module_& module);
void bind_trajectory_state(nb::module_& module);
void bind_frame(nb::module_& module);
void bind_output(nb::module_& module);
void bind_boxes(nb::module_& module);
void bind_simulator(nb::module_& module);
void bind_point_trace(nb::module_& module);
void bind_depth(nb::module_& module);
void bind_stereo(nb::module_& module);
void bind_tof(nb::module_& module);
void bind_structured_light(nb::module_& module);
void bind_tools(nb::module_& module);
void bind_yaml(nb::module_& module);

}  // namespace glidar::python
