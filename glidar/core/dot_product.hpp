// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace glidar {

/// a . b, bit-identical to Eigen's dot() on x86-64, which multiplies two components at once and
/// thereby keeps compilers from vectorising loops over beams.
inline double dot_product(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a.x() * b.x() + a.y() * b.y()) + a.z() * b.z();
}

}  // namespace glidar
