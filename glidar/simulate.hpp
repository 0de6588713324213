// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/moving_cast.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/sensor/sensor.hpp>

namespace glidar {

/// What a simulation needs; everything here must outlive it.
struct Setup {
  const Scene& scene;
  const Sensor& sensor;
  const Beams& beams;  ///< make_beams(sensor)
  const Motion& motion;
  Renderer& renderer;
  Progress progress = {};  ///< of a measurement
};

/// Measures the scene once: frame.stamp_ns and frame.seed say when and with which random numbers,
/// `fields` what truth to keep beside the range. The frame's memory is reused.
void simulate(const Setup& setup, const HitFields& fields, Frame& frame);

}  // namespace glidar
