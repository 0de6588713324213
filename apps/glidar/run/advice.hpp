// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace glidar::app {

/// A measurement and its inputs.
struct View {
  const Scene& scene;
  const Sensor& sensor;
  const Beams& beams;
  const Frame& frame;
};

/// Counts and extremes of a measurement.
struct FrameSummary {
  std::size_t beams = 0;  ///< pixels with a beam
  std::size_t hits = 0;
  std::size_t too_near = 0;
  std::size_t too_far = 0;
  double nearest_m = 0.0;  ///< of the hits' ranges; NaN without hits
  double farthest_m = 0.0;
};

FrameSummary summarise(const Frame& frame);

/// Advice about models of implausible size. None if the unit or the scale is given (`sized`), every
/// model file declares its unit, or a large scene looks like terrain or fits the sensors' largest
/// limit `far_m`.
std::vector<std::string> size_advice(const Scene& scene, bool sized, double far_m);

/// A hint at --up for formats that declare no up axis: the model is on or above zero along y and
/// across zero along the other axes. Empty: none.
std::string up_advice(const std::string& format, const Eigen::AlignedBox3d& box);
/// The default position of a LiDAR.
std::string placement_advice(const Scene& scene, const Pose& world_from_sensor);

/// A warning if the sensor measures radial velocities: poses that come one at a time have none.
std::vector<std::string> velocity_advice(const Sensor& sensor);

/// Advice about the sensor's pose: inside a model whose back faces it sees, too near or too far for
/// the model's size, or why there are no hits.
std::vector<std::string> view_advice(const View& view);

}  // namespace glidar::app
