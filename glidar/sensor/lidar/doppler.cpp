// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/doppler.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/distributions.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

constexpr double kMaxSpeed_m_s = 1e6;
constexpr double kMinSignal = 1e-9;  // a signal of 0 would have an infinite error
constexpr FieldUnit kUnitMetrePerSecond = {"m/s"};
constexpr std::uint32_t kFalseAlarmBlock = 1;  // of random words; block 0 is that of the errors

RngKey velocity_key(const Frame& frame, std::size_t entry) {
  return rng_key(frame, Purpose::radial_velocity, entry);
}

/// The velocities of a batch of entries.
void measure_batch(const Doppler& doppler, BeamRange batch, Frame& frame) {
  Batch<double> normal{};
  if (doppler.sigma_m_s > 0.0 || doppler.signal_sigma_m_s > 0.0) {
    sample_shared_normals(velocity_key(frame, batch.begin), normal);
  }
  for (std::size_t i = batch.begin; i < batch.end; ++i) {
    if (frame.status[i] != Status::hit) continue;
    const double sigma_m_s = radial_velocity_sigma_m_s(doppler, double{frame.intensity[i]},
                                                       double{frame.ground_truth.noise_scale[i]});
    double& velocity_m_s = frame.radial_velocity_m_s[i];
    velocity_m_s =
        reported_radial_velocity_m_s(doppler, velocity_m_s + sigma_m_s * normal[i - batch.begin]);
  }
}

double false_alarm_velocity_m_s(const Doppler& doppler, const Frame& frame, std::size_t entry) {
  RngKey key = velocity_key(frame, entry);
  key.block = kFalseAlarmBlock;
  const double share = 2.0 * uniform(random_words(key)[0]) - 1.0;
  return reported_radial_velocity_m_s(doppler, share * doppler.max_m_s);
}

}  // namespace

double radial_velocity_sigma_m_s(const Doppler& doppler, double signal, double scale) {
  const double constant = doppler.sigma_m_s * doppler.sigma_m_s;
  const double at_one = doppler.signal_sigma_m_s * doppler.signal_sigma_m_s;
  return scale * std::sqrt(constant + at_one / std::max(signal, kMinSignal));
}

double reported_radial_velocity_m_s(const Doppler& doppler, double velocity_m_s) {
  double reported = velocity_m_s;
  if (doppler.step_m_s > 0.0) {
    reported = std::floor(reported / doppler.step_m_s + 0.5) * doppler.step_m_s;
  }
  if (std::isfinite(doppler.max_m_s)) {
    reported = std::remainder(reported, 2.0 * doppler.max_m_s);  // exact
    if (reported >= doppler.max_m_s) reported = -doppler.max_m_s;
  }
  return reported + 0.0;  // not -0
}

double radial_velocity_normal(const Frame& frame, std::size_t entry) {
  const std::size_t in_batch = entry % kSampleBatch;
  Batch<double> normal;
  sample_shared_normals(velocity_key(frame, entry - in_batch), normal);
  return normal[in_batch];
}

void measure_radial_velocities(const Doppler& doppler, ThreadPool& thread_pool, Frame& frame) {
  constexpr std::size_t kBatchesPerTask = 8;
  const std::size_t size = frame.radial_velocity_m_s.size();
  const std::size_t batches = (size + kSampleBatch - 1) / kSampleBatch;
  thread_pool.parallel_for(batches, kBatchesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t first = k * kSampleBatch;
      measure_batch(doppler, {first, std::min(first + kSampleBatch, size)}, frame);
    }
  });
}

void complete_radial_velocities(const Doppler& doppler, Frame& frame) {
  for (std::size_t i = 0; i < frame.radial_velocity_m_s.size(); ++i) {
    if (frame.status[i] != Status::hit) {
      frame.radial_velocity_m_s[i] = kNaN;
    } else if (!frame.return_source.empty() &&
               frame.return_source[i] == ReturnSource::false_alarm) {
      frame.radial_velocity_m_s[i] = false_alarm_velocity_m_s(doppler, frame, i);
    }
  }
}

void describe(Doppler& doppler, FieldVisitor& visitor) {
  constexpr NumberRule kSpeed = {0.0, kMaxSpeed_m_s, false, "m/s from 0 to 1e6"};
  visitor.number({"sigma_m_s", "standard deviation of strong returns", kUnitMetrePerSecond}, kSpeed,
                 doppler.sigma_m_s);
  visitor.number({"signal_sigma_m_s",
                  "s, of the standard deviation that depends on the signal I: σ² = sigma² + s² / I",
                  kUnitMetrePerSecond},
                 kSpeed, doppler.signal_sigma_m_s);
  visitor.number(
      {"step_m_s", "distance between reported velocities; 0: not rounded", kUnitMetrePerSecond},
      kSpeed, doppler.step_m_s);
  visitor.number({"max_m_s", "greatest unambiguous speed v: velocities are folded into [-v, v)",
                  kUnitMetrePerSecond, false, "no limit"},
                 kAboveZero, doppler.max_m_s);
  if (visitor.is_reading() && doppler.step_m_s > doppler.max_m_s) {
    visitor.reject("step_m_s", "{}, above max_m_s", "a step of at most max_m_s");
  }
}

}  // namespace glidar
