// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/constants.hpp>
#include <simulate/panels.hpp>
#include <support/simulate.hpp>

#include <complex>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace glidar::testing {

/// A time-of-flight camera at a pose, without noise and tests of pixels.
struct TofStage {
  PanelScene panels;
  Sensor sensor;
  Pose world_from_sensor = Pose::Identity();
  std::vector<Trajectory> world_from_instance = {};  ///< empty: stationary
  RendererOptions renderer = {.threads = 2};

  TofStage(std::vector<double> frequencies_hz, std::uint32_t taps) {
    TofCamera camera;
    camera.signal_electrons = 1e14;  // shot noise of 1e-7
    camera.decoder.frequencies_hz = std::move(frequencies_hz);
    camera.decoder.taps = taps;
    camera.decoder.misfit_test = {.min_rad = 100.0, .max_rad = 100.0, .scale = 100.0};
    camera.bounces = 0;
    sensor.depth_camera = camera;
    sensor.depth_model = DepthModel::physical;
    sensor.wavelength_m = 850e-9;
    sensor.optics = pinhole_from_fov(8, 8, 1e-4);
  }

  [[nodiscard]] TofCamera& camera() { return std::get<TofCamera>(*sensor.depth_camera); }

  [[nodiscard]] Frame shoot(std::uint64_t seed = 1) const {
    const auto made = make_renderer(panels.scene, renderer);
    Simulator simulator(panels.scene, sensor, *made);
    Frame frame;
    frame.seed = seed;
    simulator.simulate(
        make_motion(panels.scene, ConstantPose{world_from_sensor}, world_from_instance), {}, frame);
    return frame;
  }
};

/// Complex amplitudes of each pixel at a frequency, exp(-j phase), in levels.
inline std::vector<std::complex<double>> phasors_of(const Frame& frame, std::size_t frequency) {
  const TofImages& images = frame.tof_images;
  const std::size_t pixels = pixel_count(images);
  std::vector<std::complex<double>> result(pixels);
  for (std::size_t k = 0; k < images.taps; ++k) {
    const auto turn = std::polar(2.0 / images.taps, -kTwoPi * static_cast<double>(k) / images.taps);
    for (std::size_t i = 0; i < pixels; ++i) {
      result[i] += turn * double{images.level[tap_offset(images, frequency, k) + i]};
    }
  }
  return result;
}

/// Their mean over all pixels.
inline std::complex<double> mean_phasor(const Frame& frame, std::size_t frequency) {
  const std::vector<std::complex<double>> all = phasors_of(frame, frequency);
  std::complex<double> sum = 0.0;
  for (const std::complex<double>& z : all) sum += z;
  return sum / static_cast<double>(all.size());
}

}  // namespace glidar::testing
