// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/simulate_imu.hpp>

#include <glidar/core/error.hpp>
#include <glidar/motion/kinematics.hpp>
#include <glidar/sensor/imu.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace glidar {
namespace {

void check(const Imu& imu, const ImuRun& run) {
  validate(imu);
  constexpr double kMaxGravity_m_s2 = 1e6;
  const Eigen::Vector3d& gravity = run.gravity_m_s2;
  if (gravity.allFinite() && gravity.cwiseAbs().maxCoeff() <= kMaxGravity_m_s2) return;
  throw Error({"imu, gravity", "a number that is not finite or too large",
               "three numbers from -1e6 to 1e6 m/s^2"});
}

void add_state(const KinematicState& state, const Eigen::Vector3d& gravity_m_s2,
               ImuSamples::GroundTruth& truth) {
  truth.angular_velocity_rad_s.push_back(state.angular_velocity_rad_s);
  truth.specific_force_m_s2.emplace_back(state.pose.linear().transpose() *
                                         (state.acceleration_m_s2 - gravity_m_s2));
  truth.world_from_imu.push_back(state.pose);
  truth.velocity_m_s.push_back(state.velocity_m_s);
}

[[noreturn]] void refuse_time() {
  throw Error({"imu", "times beyond the range of its sample numbers",
               "fewer than 2^40 samples, and times within 292 years"});
}

}  // namespace

std::int64_t imu_sample_time_ns(const Imu& imu, const ImuRun& run, std::uint64_t sample) {
  const double since_ns = static_cast<double>(sample) * kSecond_ns / imu.rate_hz;
  std::int64_t t_ns = 0;
  constexpr double kMax_ns = 9e18;
  if (sample > kMaxSamples || since_ns > kMax_ns) refuse_time();
  if (__builtin_add_overflow(run.start_ns, std::llround(since_ns), &t_ns)) refuse_time();
  return t_ns;
}

std::uint64_t first_imu_sample(const Imu& imu, const ImuRun& run, std::int64_t t_ns) {
  if (t_ns <= run.start_ns) return 0;
  std::int64_t since_ns = 0;
  if (__builtin_sub_overflow(t_ns, run.start_ns, &since_ns)) refuse_time();
  const double place = static_cast<double>(since_ns) / kSecond_ns * imu.rate_hz;
  if (!(place < static_cast<double>(kMaxSamples))) refuse_time();
  auto sample = static_cast<std::uint64_t>(place);  // within one of the result
  while (sample > 0 && imu_sample_time_ns(imu, run, sample - 1) >= t_ns) --sample;
  while (imu_sample_time_ns(imu, run, sample) < t_ns) ++sample;
  return sample;
}

ImuSamples simulate_imu(const Imu& imu, const Trajectory& world_from_imu, const ImuRun& run,
                        std::int64_t from_ns, std::int64_t until_ns) {
  check(imu, run);
  validate(world_from_imu);
  ImuSamples samples;
  samples.first = first_imu_sample(imu, run, from_ns);
  const std::uint64_t end = std::max(samples.first, first_imu_sample(imu, run, until_ns));
  if (end - samples.first > kMaxImuSamples) {
    throw Error({"imu", std::to_string(end - samples.first) + " samples",
                 "at most " + std::to_string(kMaxImuSamples) + " at once",
                 "divide the interval, or reduce the rate"});
  }
  for (std::uint64_t k = samples.first; k < end; ++k) {
    samples.t_ns.push_back(imu_sample_time_ns(imu, run, k));
    add_state(state_at(world_from_imu, samples.t_ns.back()), run.gravity_m_s2,
              samples.ground_truth);
  }
  measure(imu, run, samples);
  return samples;
}

}  // namespace glidar
