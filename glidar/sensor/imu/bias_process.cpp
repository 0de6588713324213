// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/imu/bias_process.hpp>

#include <glidar/math/distributions.hpp>
#include <glidar/math/elementary.hpp>

#include <cmath>
#include <cstddef>

namespace glidar {
namespace {

using Eigen::Vector3d;

/// The values of a process that a caller wants.
struct Wanted {
  const BiasProcess& process;
  const RngKey& key;
  std::uint64_t first;
  std::span<Vector3d> values;
};

/// Sample numbers with the values at both ends.
struct ProcessInterval {
  std::uint64_t begin;
  int level;  ///< the length is 2^level
  Vector3d at_begin;
  Vector3d at_end;
};

/// Adds the values of the wanted samples within an interval, without its end.
void descend(const Wanted& wanted, const ProcessInterval& interval) {
  const std::uint64_t end = interval.begin + (std::uint64_t{1} << interval.level);
  if (end <= wanted.first || interval.begin >= wanted.first + wanted.values.size()) return;
  if (interval.level == 0) {
    wanted.values[static_cast<std::size_t>(interval.begin - wanted.first)] += interval.at_begin;
    return;
  }
  const int level = interval.level - 1;
  const BiasProcess::Level& half = wanted.process.levels[static_cast<std::size_t>(level)];
  const std::uint64_t middle = interval.begin + (std::uint64_t{1} << level);
  const Vector3d at_middle = half.weight * (interval.at_begin + interval.at_end) +
                             half.sigma * normal_vector(key_of_sample(wanted.key, middle));
  descend(wanted, {interval.begin, level, interval.at_begin, at_middle});
  descend(wanted, {middle, level, at_middle, interval.at_end});
}

/// 1 - exp(-2 x) without cancellation.
double one_minus_square(double x) {
  constexpr double kSmall = 1e-5;  // below it the omitted term is 1e-15 of the result
  return x < kSmall ? 2.0 * x * (1.0 - x * (1.0 - x * (2.0 / 3.0))) : 1.0 - portable_exp(-2.0 * x);
}

}  // namespace

BiasProcess random_walk(double density, double rate_hz) {
  BiasProcess process;
  const double step = density / std::sqrt(rate_hz);
  process.end_weight = 1.0;
  process.end_sigma = step * std::ldexp(1.0, kMaxSampleBits / 2);
  for (int k = 0; k < kMaxSampleBits; ++k) {
    // Brownian bridge: a quarter of the variance over the whole interval
    process.levels[static_cast<std::size_t>(k)] = {0.5, step * std::sqrt(0.5 * std::ldexp(1.0, k))};
  }
  return process;
}

BiasProcess correlated_process(double sigma, double correlation_time_s, double rate_hz) {
  BiasProcess process;
  const auto steps = [&](int k) { return std::ldexp(1.0, k) / (rate_hz * correlation_time_s); };
  process.start_sigma = sigma;
  process.end_weight = portable_exp(-steps(kMaxSampleBits));
  process.end_sigma = sigma * std::sqrt(one_minus_square(steps(kMaxSampleBits)));
  for (int k = 0; k < kMaxSampleBits; ++k) {
    // the normal distribution of the middle given both ends, with r the correlation over half
    const double r = portable_exp(-steps(k));
    const double sum = 1.0 + r * r;
    process.levels[static_cast<std::size_t>(k)] = {
        r / sum, sigma * std::sqrt(one_minus_square(steps(k)) / sum)};
  }
  return process;
}

RngKey key_of_sample(RngKey key, std::uint64_t sample) {
  key.beam = static_cast<std::uint32_t>(sample);
  key.frame = static_cast<std::uint32_t>(sample >> 32U);
  return key;
}

Vector3d normal_vector(const RngKey& key) {
  const std::array<double, 4> numbers = normals(random_words(key));
  return {numbers[0], numbers[1], numbers[2]};
}

void add_process(const BiasProcess& process, const RngKey& key, std::uint64_t first,
                 std::span<Vector3d> values) {
  if (process.end_sigma == 0.0) return;
  const Vector3d start = process.start_sigma * normal_vector(key_of_sample(key, 0));
  const Vector3d end = process.end_weight * start +
                       process.end_sigma * normal_vector(key_of_sample(key, kMaxSamples));
  descend({process, key, first, values}, {0, kMaxSampleBits, start, end});
}

}  // namespace glidar
