// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace glidar {

/// Six numbers of a small displacement: rotation (rad) about x, y, z, then translation (m) along
/// x, y, z.
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

struct FisherOptions {
  double sigma_m = 0.01;  ///< of every range, when the frame has no sigma_m
  /// The frame in which the displacement is counted; identity: the sensor's own.
  Pose sensor_from_reference = Pose::Identity();
  std::optional<std::uint32_t> instance = {};  ///< only returns of this one; empty: of all
  /// Returns that graze at a smaller |cosine| are left out: each would tell as much as 1 / cosine^2
  /// others, of a surface so steep that no sensor keeps its promise there.
  double least_cosine = 0.01;
};

/// One of six independent displacements, from best to worst determined.
struct EigenDirection {
  /// Of the dimensionless information: displacements in units of sigma, rotations times length_m.
  double eigenvalue = 0.0;                 ///< 1/m^2
  bool degenerate = false;                 ///< the scan does not determine it
  Vector6 displacement = Vector6::Zero();  ///< in the reference frame
  std::string
      words;  ///< "translation along x", "rotation about z", "rotation about ... through ..."
};

/// What one scan can tell about the pose from which it was taken, by point-to-plane ranging.
///
/// The displacement xi moves the sensor's side: with T = map_from_reference, T' = T exp(xi), xi
/// counted in the reference frame. A return at point p on a surface of normal n, along the beam d,
/// has n (p + theta x p + rho + dr d) = n p, so the range changes by dr = -J xi / (n d) with
/// J = [(p x n)^T, n^T]; with an error sigma along the beam, Fisher's information is the sum of
/// J^T J / (sigma n d)^2 (J: Low, "Linear least-squares optimization for point-to-plane ICP"
/// (2004), equation 9; the sum: Censi, "On achievable accuracy for range-finder localization", ICRA
/// (2007), proposition 1). The surface's shape is taken as known, range errors as independent and
/// Gaussian.
struct FisherInformation {
  Matrix6 matrix = Matrix6::Zero();  ///< in the reference frame; 1, 1/m and 1/m^2 (rad, m)
  /// Cramer-Rao: no unbiased estimate has a smaller covariance. Infinite on the diagonal, and 0
  /// beside it, for axes that take part in a degenerate direction.
  Matrix6 covariance = Matrix6::Zero();
  Vector6 bound = Vector6::Zero();  ///< its standard deviations: rad x3, m x3
  std::array<EigenDirection, 6> directions;
  double condition = 0.0;  ///< best over worst eigenvalue; infinite when degenerate
  double length_m = 0.0;   ///< root mean square distance of the points from their middle
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  ///< of the points, in the reference frame
  std::size_t returns = 0;                             ///< that counted
  std::size_t left_out = 0;                            ///< returns that graze too much
  std::optional<double> assumed_sigma_m;               ///< empty: the frame told its own
};

/// The information of a frame whose truth has normals. Ranges and points are the true ones, so that
/// the same scene gives the same information whatever its noise. Throws Error when normals are
/// missing, a sigma is not above 0, or an option is out of range.
FisherInformation pose_information(const Frame& frame, const Beams& beams,
                                   const FisherOptions& options = {});

/// A displacement in words, with numbers in the frame it is counted in: its rotation is about an
/// axis through a point, with a pitch if it moves along too. `length_m`: lengths much smaller than
/// this are left out.
std::string describe_displacement(const Vector6& displacement, double length_m);

}  // namespace glidar
