// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/sensor: biases that change with time. Each value is a pure function of its
// sample number: nothing is accumulated, so any interval gives the same bits in any order.

#include <glidar/math/random.hpp>
#include <glidar/sensor/imu/imu.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace glidar {

/// Samples are numbered below this: 348 years at 100 Hz.
inline constexpr int kMaxSampleBits = 40;
inline constexpr std::uint64_t kMaxSamples = std::uint64_t{1} << kMaxSampleBits;

/// A Gaussian Markov process at the sample numbers 0 to 2^40, made by Levy's construction of
/// Brownian motion: first both ends, then the middle of every interval given its ends (Glasserman,
/// "Monte Carlo Methods in Financial Engineering" (2003), section 3.1.1). The middle is
/// weight (begin + end) + sigma N with a normal number N of the middle's sample number.
struct BiasProcess {
  struct Level {
    double weight = 0.0;
    double sigma = 0.0;
  };
  double start_sigma = 0.0;
  double end_weight = 0.0;  ///< of the start
  double end_sigma = 0.0;
  std::array<Level, kMaxSampleBits> levels = {};  ///< of intervals of 2^(k + 1) samples
};

/// A random walk from 0 with the density K: increments of variance K^2 / rate.
BiasProcess random_walk(double density, double rate_hz);

/// A stationary process with covariance sigma^2 exp(-|t| / T) (Ornstein and Uhlenbeck).
BiasProcess correlated_process(double sigma, double correlation_time_s, double rate_hz);

/// Adds the values of three independent processes at the samples first, first + 1, ...; the key's
/// frame and beam are ignored. Samples are below kMaxSamples.
void add_process(const BiasProcess& process, const RngKey& key, std::uint64_t first,
                 std::span<Eigen::Vector3d> values);

/// The key of a sample's random numbers.
RngKey key_of_sample(RngKey key, std::uint64_t sample);

/// Three standard normal numbers.
Eigen::Vector3d normal_vector(const RngKey& key);

}  // namespace glidar
