// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/sensor: the projection that omni, double_sphere and eucm share.

#include <Eigen/Core>

#include <optional>

namespace glidar {

/// Models of one or two spheres: a point is projected onto a unit sphere, which is shifted by xi
/// along the axis, then onto a second one, and from a point of its axis onto the image. With
/// q = (sqrt(beta) x, sqrt(beta) y, z), d1 = |q| and d2 = |(q_x, q_y, xi d1 + z)|, the image is
/// scale (x, y) / (alpha d2 + (1 - alpha) (xi d1 + z)). beta = 1: Usenko, Demmel and Cremers, "The
/// Double Sphere Camera Model", 3DV 2018; xi = 0: Khomutenko, Garcia and Martinet, "An Enhanced
/// Unified Camera Model", RA-L 2016; both: Mei and Rives, ICRA 2007, with xi = alpha / (1 - alpha).
struct Spheres {
  double xi;
  double alpha;
  double beta;
  double scale;
};

/// Where a point is imaged; empty: nowhere.
std::optional<Eigen::Vector2d> sphere_place(const Spheres& s, const Eigen::Vector3d& point);
/// Derivative of sphere_place(), where there is an image.
Eigen::Matrix<double, 2, 3> sphere_derivative(const Spheres& s, const Eigen::Vector3d& point);
/// The unit ray through a place of the image; NaN if there is none.
Eigen::Vector3d sphere_ray(const Spheres& s, const Eigen::Vector2d& place);

}  // namespace glidar
