// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/motion/motion.hpp>
#include <glidar/sensor/imu.hpp>

#include <cstdint>

namespace glidar {

/// Maximum number of samples of one call: 2.7 hours at 1 kHz, which take 2.6 GB.
inline constexpr std::uint64_t kMaxImuSamples = 10'000'000;

/// The time of a sample: start + k / rate, rounded to nanoseconds.
std::int64_t imu_sample_time_ns(const Imu& imu, const ImuRun& run, std::uint64_t sample);

/// The number of the first sample at or after a time.
std::uint64_t first_imu_sample(const Imu& imu, const ImuRun& run, std::int64_t t_ns);

/// The samples with from_ns <= t < until_ns of an IMU on this trajectory; there is none before
/// run.start_ns. A pure function: however an interval is divided into calls, the samples are the
/// same, bit for bit. Angular velocity and acceleration are exact derivatives of the trajectory at
/// the time of each sample; the specific force is R^T (a - g). Throws Error if an argument is
/// invalid, or if there are more than kMaxImuSamples.
ImuSamples simulate_imu(const Imu& imu, const Trajectory& world_from_imu, const ImuRun& run,
                        std::int64_t from_ns, std::int64_t until_ns);

}  // namespace glidar
