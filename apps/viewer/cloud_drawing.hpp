// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/io/pictures/picture.hpp>
#include <glidar/render/opengl/gl_object.hpp>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace glidar::app {

/// The mapping of numbers to colours.
enum class ColourMap : std::uint8_t { viridis, rainbow, grey };
inline constexpr std::array<std::string_view, 3> kColourMaps = {"viridis", "rainbow", "grey"};

/// The colour of a number from 0 (dark, or blue) to 1 (bright, or red), clamped.
Colour colour_of(ColourMap map, double t);

/// A vertex of a line, or a point, relative to the anchor, in the layout of the vertex buffer.
struct ColouredVertex {
  Eigen::Vector3f position_m;
  Colour colour;
  std::uint8_t opacity = 255;
};
static_assert(sizeof(ColouredVertex) == 16, "the layout of the vertex buffer");

/// Lines, two vertices each.
using Lines = std::vector<ColouredVertex>;

/// 1, 2 or 5 times a power of ten metres, about a tenth of `extent_m`.
double grid_spacing_m(double extent_m);

/// A horizontal grid around a point, `extent_m` to every side; its lines are at multiples of the
/// spacing from the anchor.
void add_grid(const Eigen::Vector3d& about_m, double extent_m, double spacing_m, Lines& lines);

/// Axes of this pose: x red, y green, z blue.
void add_axes(const Pose& anchor_from_frame, double length_m, Lines& lines);

/// The edges of boxes, 8 corners each: corner i ^ 1, i ^ 2 and i ^ 4 are the neighbours of corner
/// i.
void add_boxes(std::span<const Eigen::Vector3d> corners_m, Lines& lines);

/// The edges of the beams' frustum up to a range: the border of the beams' grid, and lines to it
/// from their origins.
void add_frustum(const Beams& beams, const Pose& anchor_from_sensor, double range_m, Lines& lines);

/// Parameters for drawing points and lines.
struct CloudView {
  int width = 1;  ///< pixels
  int height = 1;
  Eigen::Matrix4f clip_from_anchor = Eigen::Matrix4f::Identity();
  float point_size = 2.0F;  ///< pixels
};

/// Points and lines, drawn into a texture in the current context.
class CloudDrawing {
 public:
  CloudDrawing();

  void set_points(std::span<const ColouredVertex> points);
  void set_lines(std::span<const ColouredVertex> lines);
  /// Draws into the texture, whose first row is the bottom one.
  void draw(const CloudView& style);
  [[nodiscard]] GLuint texture() const { return picture_.name(); }

 private:
  /// Vertices in the device's memory.
  struct Corners {
    opengl::VertexArray arrays;
    opengl::Buffer buffer;
    GLsizei count = 0;
  };
  static void fill(std::span<const ColouredVertex> vertices, Corners& corners);
  void resize(int width, int height);

  opengl::Program program_;
  Corners points_;
  Corners lines_;
  opengl::Framebuffer frame_;
  opengl::GlTexture picture_;
  opengl::Renderbuffer depths_;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace glidar::app
