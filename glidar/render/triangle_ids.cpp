// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/triangle_ids.hpp>

#include <glidar/core/error.hpp>

#include <string>

namespace glidar {

TriangleIds::TriangleIds(const Scene& scene) {
  std::uint64_t next = 0;
  for (const Instance& instance : scene.instances) {
    first_.push_back(static_cast<std::uint32_t>(next));
    next += scene.meshes[instance.mesh].triangles.size();
    if (next < kNoTriangleId) continue;
    throw Error({.where = "raster renderer",
                 .found = "too many triangles: " + std::to_string(next),
                 .allowed = "up to 1073741822, counting every instance",
                 .remedy = "use --renderer rays"});
  }
}

}  // namespace glidar
