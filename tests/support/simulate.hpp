// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulate.hpp>
#include <glidar/simulate/simulator.hpp>

#include <memory>

namespace glidar::testing {

/// What a frame is measured of and with.
struct SimulationInputs {
  const Scene& scene;
  const Sensor& sensor;
  const Beams& beams;  ///< may differ from those of the sensor's optics
  const Motion& motion;
  Renderer& renderer;
  ProgressCallback progress = {};
};

/// Simulates one frame.
inline void simulate(const SimulationInputs& in, const HitColumnMask& hit_columns, Frame& frame) {
  Simulator simulator(in.scene, std::make_shared<const BeamCache>(in.sensor, in.beams),
                      in.renderer);
  Simulation simulation = simulator.prepare(in.beams, in.motion, hit_columns, frame, in.progress);
  glidar::simulate({&simulation, 1});
}

}  // namespace glidar::testing
