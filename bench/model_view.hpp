// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model/model.hpp>
#include <glidar/sensor/view_placement.hpp>
#include <glidar/simulate/simulator.hpp>

#include <memory>
#include <string>

namespace glidar::bench {

/// A view of a model that fills the image.
struct ModelView {
  Scene scene;
  Sensor sensor;
  Beams beams;
  Motion motion;
  std::unique_ptr<Simulator> simulator;

  ModelView(const std::string& model, unsigned threads) {
    add_model(scene, load_model(model, {}, {}));
    constexpr std::uint32_t kPixels = 256;
    sensor.optics = pinhole_from_fov(kPixels, kPixels, 0.35);
    beams = make_beams(sensor);
    motion =
        static_motion(scene, fit_camera_to_scene(beams, scene, {2.0, -3.0, 2.0}, {0.0, 0.0, 1.0}));
    simulator = std::make_unique<Simulator>(scene, sensor, RendererOptions{.threads = threads});
  }
  void measure(Frame& frame) const { simulator->simulate(motion, {}, frame); }
};

}  // namespace glidar::bench
