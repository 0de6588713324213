// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/sensor.hpp>
#include <glidar/simulate/moving_cast.hpp>

#include <functional>

namespace glidar {

/// What a simulation needs; everything here must outlive it.
struct Setup {
  const Scene& scene;
  const Sensor& sensor;
  const Beams& beams;  ///< make_beams(sensor)
  const Motion& motion;
  Renderer& renderer;
  ProgressCallback progress = {};  ///< of a measurement
  /// Called after the cast with the beams as fired (pointing noise included): replaces range,
  /// intensity and status of every beam, e.g. woods2016_measurement(). The ground truth stays that
  /// of the renderer. Empty: range and intensity come from the renderer's hits.
  std::function<void(const Setup& setup, const Beams& perturbed, Frame& frame)> replace_returns =
      {};
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
