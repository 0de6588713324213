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

/// A small displacement: rotation (rad) about x, y, z, then translation (m) along x, y, z.
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A displacement in words, in its own coordinate frame: a translation, or a rotation about an axis
/// through a point, with a pitch if it is a screw motion. Lengths much smaller than `length_m` are
/// omitted.
std::string describe_displacement(const Vector6& displacement, double length_m);

struct FisherOptions {
  double sigma_m = 0.01;  ///< of every range, if the frame has no sigma_m
  /// The coordinate frame of the displacement; identity: the sensor frame.
  Pose sensor_from_reference = Pose::Identity();
  std::optional<std::uint32_t> instance = {};  ///< only returns of this instance; empty: all
  /// Returns with a smaller |cosine| of the incidence angle are ignored: each would count as much
  /// as 1 / cosine^2 others, at an incidence for which no sensor specifies its noise.
  double least_cosine = 0.01;
};

/// One of six independent displacements, ordered from best to worst determined.
struct EigenDirection {
  /// Eigenvalue of the information with rotations scaled by length_m.
  double eigenvalue = 0.0;                 ///< 1/m^2
  bool degenerate = false;                 ///< not determined by the scan
  Vector6 displacement = Vector6::Zero();  ///< in the reference frame
  std::string
      words;  ///< "translation along x", "rotation about z", "rotation about ... through ..."
};

/// Fisher information of the sensor's pose from one scan, by point-to-plane ranging.
///
/// The displacement xi acts on the sensor's side: with T = map_from_reference, T' = T exp(xi), xi
/// in the reference frame. A return at point p on a surface with normal n, along the beam d, has n
/// (p + theta x p + rho + dr d) = n p, so the range changes by dr = -J xi / (n d) with J = [(p x
/// n)^T, n^T]; with an error sigma along the beam, Fisher's information is the sum of J^T J /
/// (sigma n d)^2 (J: Low, "Linear least-squares optimization for point-to-plane ICP" (2004),
/// equation 9; the sum: Censi, "On achievable accuracy for range-finder localization", ICRA (2007),
/// proposition 1). The shape of the surface is assumed to be known, and range errors to be
/// independent and Gaussian.
struct FisherInformation {
  Matrix6 matrix = Matrix6::Zero();  ///< in the reference frame; 1, 1/m and 1/m^2 (rad, m)
  /// Cramer-Rao bound: no unbiased estimate has a smaller covariance. Axes that are part of a
  /// degenerate direction are infinite on the diagonal and 0 elsewhere.
  Matrix6 covariance = Matrix6::Zero();
  Vector6 bound = Vector6::Zero();  ///< standard deviations of the bound: rad x3, m x3
  std::array<EigenDirection, 6> directions;
  double condition = 0.0;  ///< largest eigenvalue over smallest; infinite if degenerate
  double length_m = 0.0;   ///< root mean square distance of the points from their centroid
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  ///< centroid, in the reference frame
  std::size_t returns = 0;                             ///< number of returns used
  std::size_t left_out = 0;                            ///< returns ignored for their incidence
  std::optional<double> assumed_sigma_m;               ///< empty: the frame's sigma_m was used
};

/// The information of a frame whose ground truth has normals. It uses the ground truth ranges, so
/// noise does not change it. Throws Error if normals are missing, a sigma is not positive, or an
/// option is out of range.
FisherInformation pose_information(const Frame& frame, const Beams& beams,
                                   const FisherOptions& options = {});

}  // namespace glidar
