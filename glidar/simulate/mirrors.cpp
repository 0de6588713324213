// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/mirrors.hpp>

#include <algorithm>

namespace glidar {

bool has_mirrors(const Scene& scene, std::span<const std::uint8_t> instance_enabled) {
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (!instance_enabled.empty() && instance_enabled[i] == 0) continue;
    const std::vector<std::uint32_t>& materials = scene.instances[i].materials;
    const auto reflects = [&](std::uint32_t m) { return scene.materials[m].mirror > 0.0F; };
    if (std::any_of(materials.begin(), materials.end(), reflects)) return true;
  }
  return false;
}

const Material& material_hit(const Scene& scene, const Hits& hits, std::size_t beam) {
  return material_of(scene, scene.instances[hits.instance[beam]], hits.primitive[beam]);
}

void add_reflected_beam(const Beams& from, const Hits& hits, std::size_t ray, Beams& beams) {
  constexpr double kClear =
      1e-7;  // of the range; far above rounding, far below the resolution of sensors
  const Eigen::Vector3d direction = from.directions[ray];
  const Eigen::Vector3d normal = hits.shading_normal[ray].cast<double>().normalized();
  const double range_m = hits.range_m[ray];
  Eigen::Vector3d origin = (range_m - kClear * std::max(1.0, range_m)) * direction;
  if (!from.origins_m.empty()) origin += from.origins_m[ray];
  beams.origins_m.push_back(origin);
  beams.directions.push_back((direction - 2.0 * direction.dot(normal) * normal).normalized());
  if (!from.times_ns.empty()) beams.times_ns.push_back(from.times_ns[ray]);
}

}  // namespace glidar
