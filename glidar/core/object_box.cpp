// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/object_box.hpp>

#include <glidar/core/scene.hpp>
#include <glidar/math/constants.hpp>

#include <algorithm>

namespace glidar {

double occlusion(const ObjectBox& box) {
  if (box.beams == 0) return kNaN;
  return 1.0 - static_cast<double>(box.visible_beams) / static_cast<double>(box.beams);
}

Eigen::AlignedBox3d surface_bounds(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) box.extend(vertex_m(mesh, corner));
  }
  return box;
}

bool has_classes(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(),
                     [](const Instance& instance) { return instance.class_id != 0; });
}

}  // namespace glidar
