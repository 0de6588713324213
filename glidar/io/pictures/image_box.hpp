// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: bounding boxes of meshes in images.

#include <glidar/core/mesh.hpp>
#include <glidar/core/pose.hpp>

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

namespace glidar {

/// Rectified camera (x right, y down, z forward), in pixels; integer coordinates are pixel centres.
struct RectifiedCamera {
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
  double width = 0.0;
  double height = 0.0;
};

/// A mesh in the frame of a camera.
struct PlacedMesh {
  const Mesh& mesh;
  Pose camera_from_object;
  double scale = 1.0;

  [[nodiscard]] Eigen::Vector3d in_camera(std::uint32_t vertex) const {
    return camera_from_object * (scale * vertex_m(mesh, vertex));
  }
};

/// The box of a mesh in an image.
struct ImageBox {
  Eigen::AlignedBox2d inside;  ///< pixels, from the first pixel's centre to the last one's
  /// Fraction of the projection's box outside the image; almost 1 for a mesh that extends behind
  /// the camera, whose projection is as large as the plane of the image.
  double truncated = 0.0;
};

/// The tight box of the mesh's part in front of the camera and in the image, ignoring occlusion;
/// empty when there is none.
std::optional<ImageBox> image_box(const PlacedMesh& placed, const RectifiedCamera& camera);

}  // namespace glidar
