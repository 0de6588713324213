// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/noise/noise_trace.hpp>
#include <glidar/simulate/simulate.hpp>
#include <glidar/simulate/simulate_waveforms.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace glidar {

/// What a sensor would report of an entry at some point of its measurement.
struct Measurement {
  Status status = Status::miss;
  ReturnSource return_source = ReturnSource::none;
  double range_m = 0.0;  ///< NaN unless hit
  float intensity = 0.0F;
  float sigma_m = 0.0F;  ///< of the range's random error so far
};

/// How an entry of a frame came to be: what is not in the frame's own columns.
struct PointTrace {
  std::size_t entry = 0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< with errors of pointing, sensor's frame
  Measurement measured;                                 ///< before noise
  std::optional<WaveformTrace> pulse = {};              ///< where beams are more than a ray
  /// Of pulsed light: the normal numbers that the receiver's noise_sigma multiplies, one for each
  /// echo; of beams that are a ray, one.
  std::vector<double> receiver_noise = {};

  /// One step of noise.
  struct Step {
    std::vector<RandomSample> draws;
    Measurement after;
  };
  std::vector<Step> noise;  ///< one for each step of the sensor's list
};

/// Picks an entry of a frame as simulate() made it; what it throws goes through.
using EntrySelector = std::function<std::size_t(const Frame& frame)>;

/// Measures a frame as simulate() does, with all truth, and tells how the entry of it that is
/// picked came to be. frame.stamp_ns, seed, sensor_id and number say which; the frame comes out as
/// simulate() makes it, byte for byte. The first step of noise is run, then the first two, and so
/// on. Throws Error when there is no such entry.
PointTrace explain(const Setup& setup, const EntrySelector& pick, Frame& frame);
PointTrace explain(const Setup& setup, std::size_t entry, Frame& frame);

}  // namespace glidar
