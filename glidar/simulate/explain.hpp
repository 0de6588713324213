// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/noise/noise_trace.hpp>
#include <glidar/simulate/depth_trace.hpp>
#include <glidar/simulate/simulator.hpp>
#include <glidar/simulate/waveform_trace.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace glidar {

/// What a sensor would report of an entry after some noise steps.
struct Measurement {
  Status status = Status::miss;
  ReturnSource return_source = ReturnSource::none;
  double range_m = 0.0;  ///< without Beams::range_offset_m; NaN unless hit
  float intensity = 0.0F;
  float sigma_m = 0.0F;              ///< of the range's random error so far
  double radial_velocity_m_s = 0.0;  ///< NaN unless hit and measured
};

/// How the radial velocity of a return was measured.
struct VelocityTrace {
  double received_m_s = 0.0;  ///< without errors
  double sigma_m_s = 0.0;     ///< of its random error
  double normal = 0.0;        ///< the standard normal number of the error
};

/// How an entry of a frame was measured, as far as the frame's own columns do not state it.
struct PointTrace {
  std::size_t entry = 0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< with pointing errors, sensor's frame
  Measurement measured;                                 ///< before noise
  std::optional<WaveformTrace> waveform = {};           ///< where beams are more than a ray
  std::optional<DepthTrace> depth = {};                 ///< of cameras by DepthModel::physical
  /// Of pulsed sensors: the normal numbers that the receiver's noise_sigma multiplies, one for each
  /// echo; one for beams that are a single ray.
  std::vector<double> receiver_noise = {};

  /// Before noise steps; empty: no return, or not measured.
  std::optional<VelocityTrace> velocity = {};

  /// One noise step.
  struct Step {
    std::vector<RandomSample> samples;
    Measurement after;
  };
  std::vector<Step> noise;  ///< one for each of the sensor's noise steps
  Measurement reported;     ///< after the steps, if it is within the limits
};

/// Selects an entry of a simulated frame; its exceptions propagate.
using EntrySelector = std::function<std::size_t(const Frame& frame)>;

/// Simulates a frame with all ground truth, and traces the entry of it that is selected.
/// frame.stamp_ns, seed, sensor_id and number state which frame; it is that of
/// Simulator::simulate(), byte for byte. The first noise step is applied, then the first two, and
/// so on. Throws Error when there is no such entry.
PointTrace explain(Simulator& simulator, const Motion& motion, const EntrySelector& pick,
                   Frame& frame, const ProgressCallback& progress = {});
PointTrace explain(Simulator& simulator, const Motion& motion, std::size_t entry, Frame& frame,
                   const ProgressCallback& progress = {});

}  // namespace glidar
