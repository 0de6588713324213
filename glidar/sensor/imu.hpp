// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/random.hpp>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

// sample number: nothing is accumulated, so any interval gives the same bits in any order.

namespace glidar {

class FieldVisitor;

/// Standard gravity: The International System of Units (SI Brochure, 9th ed., 2019).
inline constexpr double kStandardGravity_m_s2 = 9.80665;

/// Gravity in a world whose z axis points up.
inline Eigen::Vector3d standard_gravity_m_s2() {
  return {0.0, 0.0, -kStandardGravity_m_s2};
}

/// The errors of the three gyroscopes or the three accelerometers of an IMU. U is rad/s or m/s^2.
/// A measurement is
///   clip(round((I + S) x + b_0 + b_i + b_w + n))
/// with the true value x, scale and misalignment errors S and a turn-on bias b_0, which are
/// constant, a correlated bias b_i, a random walk b_w and white noise n: the models of IEEE Std
/// 952-2020, annex C (gyroscopes) and IEEE Std 1293-2018, annex K (accelerometers); Woodman, "An
/// introduction to inertial navigation", UCAM-CL-TR-696 (2007), section 3; and, with the same
/// densities, of kalibr ("IMU Noise Model").
struct InertialTriad {
  double noise_density = 0.0;         ///< N of the white noise, U / sqrt(Hz)
  double random_walk = 0.0;           ///< K of the random walk of the bias, U / s / sqrt(Hz)
  double bias_instability = 0.0;      ///< U; maximum Allan deviation of the correlated bias
  double correlation_time_s = 100.0;  ///< of the correlated bias
  double turn_on_bias = 0.0;          ///< U; standard deviation
  double scale_error = 0.0;           ///< standard deviation, a fraction of the value
  double misalignment_rad = 0.0;      ///< standard deviation of each axis about each other axis
  double range = kInfinity;           ///< U; larger values are reported as this
  double resolution = 0.0;            ///< U; step of the reported values; 0: none
};

/// An inertial measurement unit: gyroscopes measure the angular velocity, accelerometers the
/// specific force, both in the IMU's own axes at the time of each sample. At rest the specific
/// force is +9.81 m/s^2 upwards (REP-145).
struct Imu {
  std::string name = "imu";
  double rate_hz = 200.0;
  InertialTriad gyroscope;      ///< rad/s
  InertialTriad accelerometer;  ///< m/s^2
};

/// Maximum of Imu::rate_hz.
inline constexpr double kMaxImuRate_hz = 1e5;

/// The same IMU without errors.
Imu ground_truth_imu(Imu imu);

/// The standard deviation of the correlated bias, an exponentially correlated (Gauss-Markov)
/// process. Its Allan deviation has a maximum of 0.6173 standard deviations at 1.89 correlation
/// times (IEEE Std 952-2020, C.1.1.5: 0.437 q sqrt(T) with the standard deviation q sqrt(T / 2)).
double correlated_bias_sigma(const InertialTriad& triad);

/// Throws Error with the invalid field unless every number is in the range that files accept.
void validate(const Imu& imu);

/// Keys of IMU files; the units are those of data sheets.
void describe(Imu& imu, FieldVisitor& visitor);

/// Identifies the random numbers of an IMU and when it was turned on.
struct ImuRun {
  std::uint64_t seed = 1;
  std::uint32_t imu = 0;      ///< number of the IMU on the rig
  std::int64_t start_ns = 0;  ///< time of sample 0
  Eigen::Vector3d gravity_m_s2 =
      standard_gravity_m_s2();  ///< acceleration of free fall, world axes
};

/// The errors that an IMU has throughout a run.
struct ImuConstants {
  Eigen::Matrix3d gyroscope_matrix;      ///< I + S: scale and misalignment
  Eigen::Matrix3d accelerometer_matrix;  ///< the same
  Eigen::Vector3d gyroscope_bias_rad_s;  ///< turn-on bias
  Eigen::Vector3d accelerometer_bias_m_s2;
};

/// Consecutive samples of an IMU; every vector has one entry per sample.
struct ImuSamples {
  using Vectors = std::vector<Eigen::Vector3d>;

  /// Without errors, at the times of the samples, in the axes of the IMU unless stated otherwise.
  struct GroundTruth {
    Vectors angular_velocity_rad_s;
    Vectors specific_force_m_s2;
    Vectors gyroscope_bias_rad_s;     ///< turn-on bias, correlated bias and random walk together
    Vectors accelerometer_bias_m_s2;  ///< the same
    std::vector<Pose> world_from_imu;
    Vectors velocity_m_s;  ///< world axes
  };

  std::uint64_t first = 0;         ///< number of the first sample
  std::vector<std::int64_t> t_ns;  ///< increasing
  Vectors angular_velocity_rad_s;  ///< measured, axes of the IMU
  Vectors specific_force_m_s2;     ///< measured, axes of the IMU; at rest +9.81 upwards
  GroundTruth ground_truth;
};

/// The constant errors: functions of seed and IMU.
ImuConstants imu_constants(const Imu& imu, const ImuRun& run);

/// Computes biases and measurements from the true angular velocity and specific force. Random
/// numbers are functions of seed, IMU and sample number. White noise has the standard deviation
/// N sqrt(rate) (kalibr, "IMU Noise Model": discrete-time noise).
void measure(const Imu& imu, const ImuRun& run, ImuSamples& samples);

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
