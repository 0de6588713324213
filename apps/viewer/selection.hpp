// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

namespace glidar::app {

/// The objects of a scene that keys, mouse and panels act on: one or all.
class Selection {
 public:
  /// Sets the scene. Selects its first object, unless the selection is kept and still exists.
  void begin(const Scene& scene, bool is_kept);
  /// Empty: all objects. An object that does not exist is ignored.
  void select(std::optional<std::size_t> object);

  /// Index of the selected instance; empty: all.
  [[nodiscard]] std::optional<std::size_t> object() const { return object_; }
  [[nodiscard]] bool includes(std::size_t object) const { return !object_ || *object_ == object; }

  /// Corners of the bounding boxes of the selected objects at the frame's time, in the world: 8 for
  /// each object with vertices.
  [[nodiscard]] std::vector<Eigen::Vector3d> corners_m(const Frame& frame) const;

 private:
  std::vector<Eigen::AlignedBox3d> boxes_m_;  ///< per instance, in the object's frame, scaled
  std::optional<std::size_t> object_;
};

}  // namespace glidar::app
