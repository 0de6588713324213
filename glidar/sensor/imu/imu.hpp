// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/constants.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <string>

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

}  // namespace glidar
