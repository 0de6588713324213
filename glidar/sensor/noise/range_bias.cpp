// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/range_bias.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/noise/noise_batch.hpp>

#include <cmath>

namespace glidar {
namespace {

/// Adds error_of(ring) to every range; calls it once for consecutive beams of one ring.
template <class Function>
void add_by_ring(const Beams& beams, const Function& error_of, NoiseBatch& batch) {
  std::uint32_t ring = ring_of(beams, batch.first);
  double error = error_of(ring);
  for (std::size_t i = 0; i < batch.count; ++i) {
    const std::uint32_t next = ring_of(beams, batch.first + i);
    if (next != ring) error = error_of(next);
    ring = next;
    batch.range_m[i] += error;
  }
}

double normal_of(const RngKey& key) {
  return normals(random_words(key))[0];
}

/// Records the number of the beam's ring.
template <class Function>
void record_by_ring(const char* use, const Beams& beams, const Function& normal_of_ring,
                    const NoiseBatch& batch) {
  record(batch.sampler, [&](std::size_t i) {
    return RandomSample{.value = normal_of_ring(ring_of(beams, batch.first + i)), .use = use};
  });
}

}  // namespace

double drift_at(std::uint32_t frame, double frames_per_tau, RngKey key) {
  constexpr double kDecorrelated = 13.8;  // exp(-13.8) = 1e-6
  constexpr unsigned kLongest = 31;
  unsigned level = 0;
  while (level < kLongest &&
         std::ldexp(1.0, static_cast<int>(level)) < kDecorrelated * frames_per_tau)
    ++level;
  const auto normal_at = [&](std::uint64_t at) {
    // The end of the last interval may be one beyond the largest frame number.
    key.frame = static_cast<std::uint32_t>(at);
    key.block = static_cast<std::uint32_t>(at >> 32U);
    return normal_of(key);
  };
  std::uint64_t begin = std::uint64_t{frame} >> level << level;
  double value_at_begin = normal_at(begin);
  double value_at_end = normal_at(begin + (std::uint64_t{1} << level));
  while (begin != frame) {
    --level;
    const std::uint64_t half = std::uint64_t{1} << level;
    const double p = portable_exp(-static_cast<double>(half) / frames_per_tau);
    const double middle = (value_at_begin + value_at_end) * p / (1.0 + p * p) +
                          std::sqrt((1.0 - p * p) / (1.0 + p * p)) * normal_at(begin + half);
    if (frame >= begin + half) {
      begin += half;
      value_at_begin = middle;
    } else {
      value_at_end = middle;
    }
  }
  return value_at_begin;
}

void apply(const RangeBias& step, const NoiseView& view, NoiseBatch& batch) {
  RngKey key = batch.sampler.key;
  key.frame = kAllFrames;
  const auto normal_of_ring = [&](std::uint32_t ring) {
    key.beam = ring;
    return normal_of(key);
  };
  if (step.sigma_m > 0.0) {
    record_by_ring("bias of the ring, constant over all frames", view.beams, normal_of_ring, batch);
  }
  add_by_ring(
      view.beams,
      [&](std::uint32_t ring) { return step.offset_m + step.sigma_m * normal_of_ring(ring); },
      batch);
}

void apply(const RangeDrift& step, const NoiseView& view, NoiseBatch& batch) {
  const double frames_per_tau = step.tau_s / batch.frame_s;
  RngKey key = batch.sampler.key;
  const auto drift_of = [&](std::uint32_t ring) {
    key.beam = ring;
    return drift_at(view.frame.number, frames_per_tau, key);
  };
  const auto error_of = [&](std::uint32_t ring) { return step.sigma_m * drift_of(ring); };
  if (step.per_ring) {
    record_by_ring("drift of the ring", view.beams, drift_of, batch);
    add_by_ring(view.beams, error_of, batch);
    return;
  }
  record(batch.sampler, [&](std::size_t /*i*/) {
    return RandomSample{.value = drift_of(0), .use = "drift of the sensor"};
  });
  const double error = error_of(0);
  for (std::size_t i = 0; i < batch.count; ++i) batch.range_m[i] += error;
}

void describe(RangeBias& step, FieldVisitor& visitor) {
  visitor.number({"offset_m", "error of all ranges", kUnitMetre}, kFinite, step.offset_m);
  visitor.number({"sigma_m", "standard deviation of the rings' constant errors", kUnitMetre},
                 kFromZero, step.sigma_m);
}

void describe(RangeDrift& step, FieldVisitor& visitor) {
  constexpr NumberRule kDriftTime = {0.0, 1e6, true, "seconds above 0 and below 1e6"};
  visitor.number({"sigma_m", "standard deviation", kUnitMetre, kRequired}, kFromZero, step.sigma_m);
  visitor.number({"tau_s", "correlation time τ", kUnitSecond, kRequired}, kDriftTime, step.tau_s);
  visitor.boolean({"per_ring", "each ring drifts independently"}, step.per_ring);
}

}  // namespace glidar
