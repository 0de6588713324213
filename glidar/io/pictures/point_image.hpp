// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/io/formats/cloud_file.hpp>
#include <glidar/io/pictures/chart.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace glidar {

/// The points of a cloud that a picture shows.
struct ShownPoints {
  std::vector<Eigen::Vector3d> points_m;  ///< in a frame with z up
  std::vector<std::size_t> entries;       ///< of the cloud, one per point
};

/// Colours of points and their key: a bar, or a legend for classes and instances.
struct PointColours {
  std::vector<Colour> colours;  ///< one per point
  std::optional<ColourBar> bar;
  std::vector<LegendEntry> legend;  ///< the most frequent first
};

/// Colours points as options.picture specifies: radial velocities blue towards the sensor, white at
/// 0 and red away from it. Throws Error when a camera is to be coloured by ring, or by radial
/// velocities that the sensor does not measure.
PointColours colour_points(const CloudFile& job, const ShownPoints& shown);

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

/// The visible point of each pixel, row by row from the top.
struct PointImage {
  static constexpr std::uint32_t kNoPoint = 0xFFFFFFFFU;

  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint32_t> points;  ///< kNoPoint for none
  std::vector<double> depths;         ///< infinite for no point; smaller is in front
  std::size_t outside = 0;            ///< number of points outside the image
};

/// A view from above on points in a frame with z up: x to the right, y up, equal scales.
struct TopView {
  double left_m = 0.0;
  double right_m = 1.0;
  double bottom_m = 0.0;
  double top_m = 1.0;
};

/// The view with this aspect ratio (width over height) that shows all points and `also_m`, except
/// distant outliers.
TopView fit_top_view(std::span<const Eigen::Vector3d> points_m, const Eigen::Vector3d& also_m,
                     double shape);

/// Draws points as dots; the highest point is visible. Depth is minus the height.
PointImage draw_top_view(std::span<const Eigen::Vector3d> points_m, const TopView& view,
                         std::size_t width, std::size_t height);

/// A pinhole camera in a frame with z up.
struct Perspective {
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_m = Eigen::Vector3d::UnitX();
  std::size_t width = 1;
  std::size_t height = 1;

  /// Column, row and depth of a point; depth <= 0: behind the camera.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& point_m) const;
};

/// A camera behind, above and to the right of the sensor that sees most of the points.
Perspective fit_perspective(std::span<const Eigen::Vector3d> points_m, std::size_t width,
                            std::size_t height);

/// Draws points as dots, near ones larger; the nearest point is visible.
PointImage draw_perspective(std::span<const Eigen::Vector3d> points_m, const Perspective& view);

/// The brightness factor of each pixel: smaller behind a depth edge ("eye-dome lighting",
/// Boucheny, PhD thesis, Grenoble 2009), which emphasises shapes. Pixels without a point have 1.
std::vector<double> shade_edges(const PointImage& image);

}  // namespace glidar
