// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/depth_camera/active_stereo.hpp>
#include <glidar/sensor/depth_camera/structured_light_camera.hpp>
#include <glidar/tof/tof_camera.hpp>

#include <cstdint>
#include <variant>

namespace glidar {

class FieldVisitor;

/// How a depth camera's measurement is simulated.
enum class DepthModel : std::uint8_t {
  law,      ///< the true depth with the sensor's noise steps
  physical  ///< from the raw images of the sensor's depth_camera, without noise steps
};

/// What DepthModel::physical simulates.
using DepthCamera = std::variant<ActiveStereo, TofCamera, StructuredLightCamera>;

/// Keys of `depth_camera` of sensor files: `type` and those of the type.
void describe(DepthCamera& camera, FieldVisitor& visitor);

/// Key `depth_model` of sensor files.
void visit_depth_model(DepthModel& model, FieldVisitor& visitor);

}  // namespace glidar
