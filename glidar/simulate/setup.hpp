// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/woods2016_framebuffer.hpp>
#include <glidar/sensor/sensor.hpp>
#include <glidar/simulate/moving_cast.hpp>

#include <optional>

namespace glidar {

/// The way of the 2016 paper: range and intensity are read from a picture of bytes, which stays in
/// the frame.
struct Woods2016Target {
  Woods2016Camera& camera;  ///< over the same scene
  std::optional<Woods2016DepthPlanes> planes =
      {};  ///< of its depths; empty: they hug what is in view
};

/// What a simulation needs; everything here must outlive it.
struct Setup {
  const Scene& scene;
  const Sensor& sensor;
  const Beams& beams;  ///< make_beams(sensor)
  const Motion& motion;
  Renderer& renderer;
  ProgressCallback progress = {};  ///< of a measurement
  /// Empty: range and intensity come from the renderer's hits, which stay the truth in any case.
  std::optional<Woods2016Target> paper = {};
};

/// The world at the frame's start.
inline TimedScene timed_scene(const Setup& setup, const Frame& frame) {
  return {setup.renderer, setup.scene, setup.motion, frame.stamp_ns};
}

/// A cast of these beams at the frame's start.
inline CastRequest request_of(const Setup& setup, const Frame& frame, const Beams& beams,
                              const HitFieldMask& fields) {
  return {.beams = beams,
          .world_from_sensor = frame.world_from_sensor,
          .world_from_instance = frame.world_from_instance,
          .fields = fields,
          .cull_back_faces = setup.sensor.cull_back_faces};
}

}  // namespace glidar
