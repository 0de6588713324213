// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/sensor/imu/imu.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

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

}  // namespace glidar
