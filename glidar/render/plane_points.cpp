// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/plane_points.hpp>

#include <glidar/math/simd.hpp>

#include <cmath>

namespace glidar {

void find_plane_points(const Beams& beams, PlanePoints& points) {
  points.x.clear();
  points.y.clear();
  if (!beams.pinhole) return;
  for (std::uint32_t u = 0; u < beams.cols; ++u) points.x.push_back(plane_x(*beams.pinhole, u));
  for (std::uint32_t v = 0; v < beams.rows; ++v) points.y.push_back(plane_y(*beams.pinhole, v));
}

GLIDAR_SIMD void directions_through(const Lanes<double>& x, const Lanes<double>& y,
                                    Lanes3<double>& out) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const double length = std::sqrt(x[i] * x[i] + y[i] * y[i] + 1.0);
    out.x[i] = x[i] / length;
    out.y[i] = y[i] / length;
    out.z[i] = 1.0 / length;
  }
}

}  // namespace glidar
