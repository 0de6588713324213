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

/// A measurement and what it was made of.
struct View {
  const Scene& scene;
  const Sensor& sensor;
  const Beams& beams;
  const Frame& frame;
};

/// Counts and extremes of a measurement.
struct FrameSummary {
  std::size_t beams = 0;  ///< pixels that have one
  std::size_t hits = 0;
  std::size_t too_near = 0;
  std::size_t too_far = 0;
  double nearest_m = 0.0;  ///< of the hits' ranges; NaN without hits
  double farthest_m = 0.0;
};

FrameSummary summarise(const Frame& frame);

/// What the user should know about a model of doubtful size. Nothing where the unit or the scale
/// was given (`sized`), or every model file declares its unit.
std::vector<std::string> size_advice(const Scene& scene, bool sized);

/// A hint at --up, for formats that declare no up axis: a guess from how the model is placed, on or
/// above zero along y and across zero along the others. Empty: none.
std::string up_advice(const std::string& format, const Eigen::AlignedBox3d& box);
/// Where a LiDAR was put that no option placed.
std::string placement_advice(const Scene& scene, const Pose& world_from_sensor);

/// What the user should know about where the sensor stands: inside a model of which it sees the
/// backs alone while it looks one way, too near or too far for its size, or nothing hit and why.
std::vector<std::string> view_advice(const View& view);

}  // namespace glidar::app
