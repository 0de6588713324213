// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/shading.hpp>

#include <glidar/math/simd.hpp>
#include <glidar/render/corners.hpp>

#include <cmath>

namespace glidar {

GLIDAR_SIMD void interpolate_weights(const ExactHits& e, const CornerBlock& c, Lanes<float>& w1,
                                     Lanes<float>& w2) {
  constexpr float kThird = 1.0F / 3.0F;
  for (unsigned i = 0; i < kLanes; ++i) {
    const CornerAreas areas = areas_around(e, c, i);
    const float whole = areas.at_0 + areas.at_1 + areas.at_2;
    const bool has_area = whole != 0.0F;
    w1[i] = has_area ? areas.at_1 / whole : kThird;
    w2[i] = has_area ? areas.at_2 / whole : kThird;
  }
}

GLIDAR_SIMD void blend_normals(const CornerBlock& n, const Lanes<float>& w1, const Lanes<float>& w2,
                               const Lanes3<double>& flat, Lanes3<double>& out) {
  constexpr float kShortest = 1e-12F;  // squared; opposite normals cancel out
  for (unsigned i = 0; i < kLanes; ++i) {
    const float w0 = 1.0F - w1[i] - w2[i];
    const float x = w0 * n.c0.x[i] + w1[i] * n.c1.x[i] + w2[i] * n.c2.x[i];
    const float y = w0 * n.c0.y[i] + w1[i] * n.c1.y[i] + w2[i] * n.c2.y[i];
    const float z = w0 * n.c0.z[i] + w1[i] * n.c1.z[i] + w2[i] * n.c2.z[i];
    const float squared = x * x + y * y + z * z;
    const bool has_length = squared > kShortest;
    const float inverse = 1.0F / std::sqrt(has_length ? squared : 1.0F);
    out.x[i] = has_length ? static_cast<double>(x * inverse) : flat.x[i];
    out.y[i] = has_length ? static_cast<double>(y * inverse) : flat.y[i];
    out.z[i] = has_length ? static_cast<double>(z * inverse) : flat.z[i];
  }
}

GLIDAR_SIMD void cosines(const ExactHits& e, const Lanes3<double>& normal, Lanes<float>& out) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const double along = normal.x[i] * e.direction.x[i] + normal.y[i] * e.direction.y[i] +
                         normal.z[i] * e.direction.z[i];
    out[i] = static_cast<float>(e.cosine[i] > 0.0 ? along : -along);
  }
}

}  // namespace glidar
