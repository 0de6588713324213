// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

namespace glidar {

struct Mesh;
struct Scene;

/// The oriented bounding box of an object at the start of a frame, and how much of the object the
/// sensor sees. "Beams" are those of the nominal optics, without pointing errors and widths, each
/// at its firing time and once however many returns it has; limits of range do not matter.
struct ObjectBox {
  std::uint32_t instance = 0;  ///< index into Scene::instances
  /// The box's centre and axes, which are those of the object, in the sensor frame at stamp_ns.
  Pose sensor_from_box = Pose::Identity();
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< along the box's x, y and z; tight
  /// Of the centre relative to the world at stamp_ns, in the axes of the sensor.
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  std::uint32_t points = 0;         ///< returns of the frame whose ground truth is this object
  std::uint32_t beams = 0;          ///< that would hit the object if it were alone
  std::uint32_t visible_beams = 0;  ///< of these, those that hit it first in the scene
};

/// The objects that get a box.
enum class BoxSelection : std::uint8_t { with_class, all };

/// The fraction of the beams that would hit the object if it were alone, but hit another one first:
/// 1 - visible_beams / beams. NaN where no beam would hit it.
double occlusion(const ObjectBox& box);

/// The box around the corners of all triangles, in the object frame and before scale; an empty box
/// for a mesh without triangles.
Eigen::AlignedBox3d surface_bounds(const Mesh& mesh);

/// True when an instance of the scene has a class.
bool has_classes(const Scene& scene);

}  // namespace glidar
