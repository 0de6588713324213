// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/selection.hpp>

namespace glidar::app {

void Selection::begin(const Scene& scene, bool is_kept) {
  std::vector<Eigen::AlignedBox3d> meshes;
  for (const Mesh& mesh : scene.meshes) meshes.push_back(bounds(mesh));
  boxes_m_.clear();
  for (const Instance& instance : scene.instances) {
    const Eigen::AlignedBox3d& box = meshes[instance.mesh];
    boxes_m_.push_back(box.isEmpty() ? box
                                     : Eigen::AlignedBox3d(instance.scale * box.min(),
                                                           instance.scale * box.max()));
  }
  if (is_kept && (!object_ || *object_ < boxes_m_.size())) return;
  object_.reset();
  select(0);
}

void Selection::select(std::optional<std::size_t> object) {
  if (!object || *object < boxes_m_.size()) object_ = object;
}

std::vector<Eigen::Vector3d> Selection::corners_m(const Frame& frame) const {
  std::vector<Eigen::Vector3d> corners;
  for (std::size_t i = 0; i < boxes_m_.size(); ++i) {
    if (!includes(i) || boxes_m_[i].isEmpty()) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
      corners.emplace_back(frame.world_from_instance[i] * boxes_m_[i].corner(type));
    }
  }
  return corners;
}

}  // namespace glidar::app
