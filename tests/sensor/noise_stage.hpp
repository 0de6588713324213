// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/noise/noise.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace glidar::testing {

/// A frame of a synthetic sensor whose beams are all parallel to the boresight, so that range is
/// depth.
struct NoiseStage {
  static constexpr double kFrame_s = 0.1;

  Beams beams;
  Frame frame;
  ThreadPool thread_pool{2};
  NoiseWorkspace workspace;
  Beams perturbed;  ///< memory for perturb()

  NoiseStage(std::uint32_t rows, std::uint32_t cols, double range_m, double intensity = 1.0) {
    beams.rows = rows;
    beams.cols = cols;
    beams.directions.assign(std::size_t{rows} * cols, Eigen::Vector3d::UnitZ());
    frame.rows = rows;
    frame.cols = cols;
    frame.seed = 1;
    resize(frame, beams.size());
    reset(range_m, intensity);
  }

  void reset(double range_m, double intensity = 1.0) {
    std::fill(frame.range_m.begin(), frame.range_m.end(), range_m);
    std::fill(frame.intensity.begin(), frame.intensity.end(), static_cast<float>(intensity));
    std::fill(frame.status.begin(), frame.status.end(), Status::hit);
  }

  void lose_beam(std::size_t beam) {
    frame.range_m[beam] = std::nan("");
    frame.status[beam] = Status::miss;
    frame.intensity[beam] = 0.0F;
  }

  const Beams& perturb(const std::vector<NoiseStep>& noise) {
    return perturb_directions(plan_noise(noise, kFrame_s), beams, frame, thread_pool, perturbed);
  }

  void apply(const std::vector<NoiseStep>& noise) {
    apply_noise(plan_noise(noise, kFrame_s), beams, thread_pool, workspace, frame);
  }
};

struct Moments {
  double mean = 0.0;
  double sigma = 0.0;
  double count = 0.0;
};

/// Of the finite values.
template <class T>
Moments moments(const std::vector<T>& values) {
  Moments m;
  double sum = 0.0;
  for (const T value : values) {
    if (!std::isfinite(value)) continue;
    sum += value;
    m.count += 1.0;
  }
  m.mean = sum / m.count;
  double squares = 0.0;
  for (const T value : values) {
    if (std::isfinite(value)) squares += (value - m.mean) * (value - m.mean);
  }
  m.sigma = std::sqrt(squares / m.count);
  return m;
}

/// Expects mean and standard deviation within four standard errors of those of a normal sample.
inline void expect_normal(const Moments& m, double mean, double sigma) {
  constexpr double kSigmas = 4.0;
  EXPECT_LT(std::abs(m.mean - mean), kSigmas * sigma / std::sqrt(m.count));
  EXPECT_LT(std::abs(m.sigma - sigma), kSigmas * sigma / std::sqrt(2.0 * m.count));
}

}  // namespace glidar::testing
