// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/imu/imu_samples.hpp>

#include <glidar/sensor/imu/bias_process.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace glidar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using VectorList = ImuSamples::Vectors;

/// Blocks of random words of a triad and purpose.
constexpr std::uint32_t kGyroscope = 0;
constexpr std::uint32_t kAccelerometer = 1;

RngKey key_of(const ImuRun& run, Purpose purpose, std::uint32_t block) {
  return {.seed = run.seed, .sensor = run.imu, .purpose = purpose, .block = block};
}

/// Three normal numbers that an IMU has throughout a run.
Vector3d constant_normals(const ImuRun& run, std::uint32_t triad, std::uint32_t which) {
  constexpr std::uint32_t kPerTriad = 4;
  return normal_vector(key_of(run, Purpose::imu_constants, kPerTriad * triad + which));
}

/// I + S. Each axis is misaligned independently, so S has nine independent entries (Woodman,
/// UCAM-CL-TR-696, section 3.2.5; kalibr's "scale-misalignment" model).
Matrix3d constant_matrix(const InertialTriad& triad, const ImuRun& run, std::uint32_t number) {
  Matrix3d matrix = Matrix3d::Identity();
  const Vector3d scale = triad.scale_error * constant_normals(run, number, 1);
  const Vector3d above = triad.misalignment_rad * constant_normals(run, number, 2);
  const Vector3d below = triad.misalignment_rad * constant_normals(run, number, 3);
  matrix.diagonal() += scale;
  matrix(0, 1) = above[0];
  matrix(0, 2) = above[1];
  matrix(1, 2) = above[2];
  matrix(1, 0) = below[0];
  matrix(2, 0) = below[1];
  matrix(2, 1) = below[2];
  return matrix;
}

double reported(const InertialTriad& triad, double value) {
  if (triad.resolution > 0.0) {
    value = triad.resolution * std::floor(value / triad.resolution + 0.5);
  }
  return std::clamp(value, -triad.range, triad.range);
}

/// The errors of one triad in a run.
struct TriadErrors {
  const InertialTriad& triad;
  std::uint32_t number;
  double rate_hz;
  const ImuRun& run;
  std::uint64_t first;  ///< number of the first sample
  Matrix3d matrix;
  Vector3d turn_on_bias;
};

void sample_biases(const TriadErrors& errors, VectorList& biases) {
  const InertialTriad& triad = errors.triad;
  std::fill(biases.begin(), biases.end(), errors.turn_on_bias);
  add_process(
      correlated_process(correlated_bias_sigma(triad), triad.correlation_time_s, errors.rate_hz),
      key_of(errors.run, Purpose::imu_correlated_bias, errors.number), errors.first, biases);
  add_process(random_walk(triad.random_walk, errors.rate_hz),
              key_of(errors.run, Purpose::imu_random_walk, errors.number), errors.first, biases);
}

void measure_triad(const TriadErrors& errors, const VectorList& truth, VectorList& biases,
                   VectorList& measured) {
  biases.resize(truth.size());
  measured.resize(truth.size());
  sample_biases(errors, biases);
  const double sigma = errors.triad.noise_density * std::sqrt(errors.rate_hz);
  const RngKey key = key_of(errors.run, Purpose::imu_noise, errors.number);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    Vector3d value = errors.matrix * truth[i] + biases[i];
    if (sigma > 0.0) value += sigma * normal_vector(key_of_sample(key, errors.first + i));
    for (double& axis : value) axis = reported(errors.triad, axis);
    measured[i] = value;
  }
}

}  // namespace

ImuConstants imu_constants(const Imu& imu, const ImuRun& run) {
  return {.gyroscope_matrix = constant_matrix(imu.gyroscope, run, kGyroscope),
          .accelerometer_matrix = constant_matrix(imu.accelerometer, run, kAccelerometer),
          .gyroscope_bias_rad_s = imu.gyroscope.turn_on_bias * constant_normals(run, kGyroscope, 0),
          .accelerometer_bias_m_s2 =
              imu.accelerometer.turn_on_bias * constant_normals(run, kAccelerometer, 0)};
}

void measure(const Imu& imu, const ImuRun& run, ImuSamples& samples) {
  const ImuConstants constants = imu_constants(imu, run);
  ImuSamples::GroundTruth& truth = samples.ground_truth;
  measure_triad({imu.gyroscope, kGyroscope, imu.rate_hz, run, samples.first,
                 constants.gyroscope_matrix, constants.gyroscope_bias_rad_s},
                truth.angular_velocity_rad_s, truth.gyroscope_bias_rad_s,
                samples.angular_velocity_rad_s);
  measure_triad({imu.accelerometer, kAccelerometer, imu.rate_hz, run, samples.first,
                 constants.accelerometer_matrix, constants.accelerometer_bias_m_s2},
                truth.specific_force_m_s2, truth.accelerometer_bias_m_s2,
                samples.specific_force_m_s2);
}

}  // namespace glidar
