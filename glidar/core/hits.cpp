// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/hits.hpp>

namespace glidar {

void resize(Hits& hits, std::size_t size, const HitFields& fields) {
  const auto size_if = [size](bool asked) { return asked ? size : std::size_t{0}; };
  hits.range_m.resize(size);
  hits.instance.resize(size);
  hits.primitive.resize(size);
  hits.depth_m.resize(size_if(fields.depth));
  hits.normal.resize(size_if(fields.normal));
  hits.shading_normal.resize(size_if(fields.shading_normal));
  hits.cos_incidence.resize(size_if(fields.incidence));
  hits.barycentrics.resize(size_if(fields.barycentrics));
  hits.colour.resize(size_if(fields.colour));
  hits.reflectance.resize(size_if(fields.reflectance));
  hits.object_point_m.resize(size_if(fields.object_point));
  hits.noise_scale.resize(size_if(fields.noise_scale));
}

}  // namespace glidar
