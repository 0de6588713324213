// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/moving_cast.hpp>
#include <glidar/render/paper_picture.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/sensor/sensor.hpp>

#include <optional>

namespace glidar {

/// The way of the 2016 paper: range and intensity are read from a picture of bytes.
struct PaperTarget {
  PaperCamera& camera;                     ///< over the same scene
  PaperPicture& picture;                   ///< the last one drawn
  std::optional<PaperPlanes> planes = {};  ///< of its depths; empty: they hug what is in view
};

/// What a simulation needs; everything here must outlive it.
struct Setup {
  const Scene& scene;
  const Sensor& sensor;
  const Beams& beams;  ///< make_beams(sensor)
  const Motion& motion;
  Renderer& renderer;
  Progress progress = {};  ///< of a measurement
  /// Empty: range and intensity come from the renderer's hits, which stay the truth in any case.
  std::optional<PaperTarget> paper = {};
};

/// Measures the scene once: frame.stamp_ns and frame.seed say when and with which random numbers,
/// `fields` what truth to keep beside the range. The frame's memory is reused.
void simulate(const Setup& setup, const HitFields& fields, Frame& frame);

}  // namespace glidar
