// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/cloud_drawing.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/render/opengl/program.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

namespace glidar::app {

/// The embedded text of a file of shaders/; throws std::out_of_range for an unknown name.
std::string_view shader_text(std::string_view file);

Colour colour_of(ColourMap map, double t) {
  constexpr double kBlue = 2.0 / 3.0;
  t = std::clamp(t, 0.0, 1.0);
  switch (map) {
    case ColourMap::rainbow:
      return hue(kBlue * (1.0 - t));
    case ColourMap::grey:
      return grey(t);
    case ColourMap::viridis:
      break;
  }
  return viridis(t);
}

namespace {

constexpr Colour kGrid = {120, 120, 130};
constexpr Colour kSelected = {255, 140, 40};
constexpr Colour kFrustum = {255, 200, 80};

void add(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, Colour colour,
         std::uint8_t opacity, Lines& lines) {
  lines.push_back({from_m.cast<float>(), colour, opacity});
  lines.push_back({to_m.cast<float>(), colour, opacity});
}

/// Entries along a row or column of the beams' grid, at most so many, including both ends.
std::vector<std::size_t> along(std::size_t first, std::size_t step, std::size_t count) {
  constexpr std::size_t kMax = 96;
  const std::size_t parts = std::min(count - 1, kMax);
  std::vector<std::size_t> entries = {first};
  for (std::size_t i = 1; i <= parts; ++i) {
    entries.push_back(first + step * (i * (count - 1) / parts));
  }
  return entries;
}

/// The point of a beam at a range; empty without a beam.
std::optional<Eigen::Vector3d> tip(const Beams& beams, std::size_t beam, double range_m) {
  if (std::isnan(beams.directions[beam].x())) return std::nullopt;
  const Eigen::Vector3d reach = range_m * beams.directions[beam];
  return beams.origins_m.empty() ? reach : Eigen::Vector3d(beams.origins_m[beam] + reach);
}

/// A polyline through the ends of these beams, and lines to some of them from their origins.
struct Edge {
  std::vector<std::size_t> entries;
  std::size_t ray_every;  ///< entries per line; the ends always have one
};

void add_edge(const Beams& beams, const Pose& anchor_from_sensor, double range_m, const Edge& edge,
              Lines& lines) {
  constexpr std::uint8_t kHalf = 150;
  const auto draw = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    add(anchor_from_sensor * from, anchor_from_sensor * to, kFrustum, kHalf, lines);
  };
  std::optional<Eigen::Vector3d> before;
  for (std::size_t k = 0; k < edge.entries.size(); ++k) {
    const std::optional<Eigen::Vector3d> at = tip(beams, edge.entries[k], range_m);
    if (at && before) draw(*before, *at);
    const bool has_ray = k % edge.ray_every == 0 || k + 1 == edge.entries.size();
    if (at && has_ray) draw(*tip(beams, edge.entries[k], 0.0), *at);
    before = at;
  }
}

}  // namespace

double grid_spacing_m(double extent_m) {
  const double wanted = extent_m / 10.0;
  const double power = power_of_ten(decimal_exponent(wanted));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= wanted) return digit * power;
  }
  return power;
}

void add_grid(const Eigen::Vector3d& about_m, double extent_m, double spacing_m, Lines& lines) {
  constexpr std::uint8_t kFaint = 70;
  const auto half = static_cast<int>(std::floor(extent_m / spacing_m));
  const Eigen::Vector2d middle = (about_m.head<2>() / spacing_m).array().round() * spacing_m;
  const double reach = half * spacing_m;
  for (int i = -half; i <= half; ++i) {
    const double x = middle.x() + i * spacing_m;
    const double y = middle.y() + i * spacing_m;
    add({x, middle.y() - reach, about_m.z()}, {x, middle.y() + reach, about_m.z()}, kGrid, kFaint,
        lines);
    add({middle.x() - reach, y, about_m.z()}, {middle.x() + reach, y, about_m.z()}, kGrid, kFaint,
        lines);
  }
}

void add_axes(const Pose& anchor_from_frame, double length_m, Lines& lines) {
  constexpr std::array<Colour, 3> kAxes = {Colour{235, 80, 80}, Colour{90, 210, 90},
                                           Colour{100, 140, 255}};
  for (int axis = 0; axis < 3; ++axis) {
    add(anchor_from_frame.translation(),
        anchor_from_frame * (length_m * Eigen::Vector3d(Eigen::Vector3d::Unit(axis))),
        kAxes.at(static_cast<std::size_t>(axis)), 255, lines);
  }
}

void add_boxes(std::span<const Eigen::Vector3d> corners_m, Lines& lines) {
  constexpr std::uint8_t kClear = 200;
  for (std::size_t i = 0; i < corners_m.size(); ++i) {
    for (const std::size_t axis : {1U, 2U, 4U}) {
      if ((i & axis) == 0) add(corners_m[i], corners_m[i + axis], kSelected, kClear, lines);
    }
  }
}

void add_frustum(const Beams& beams, const Pose& anchor_from_sensor, double range_m, Lines& lines) {
  const std::size_t cols = beams.cols;
  const std::size_t rows = beams.returns > 0 ? beams.rows / beams.returns : 0;
  if (rows == 0 || cols == 0) return;
  const bool is_wide = cols > 8 * rows;  // such as panoramic scanners
  const std::size_t ray_every = is_wide ? 24 : std::max(rows, cols);
  for (const Edge& edge :
       {Edge{along(0, 1, cols), ray_every}, Edge{along((rows - 1) * cols, 1, cols), ray_every},
        Edge{along(0, cols, rows), ray_every}, Edge{along(cols - 1, cols, rows), ray_every}}) {
    add_edge(beams, anchor_from_sensor, range_m, edge, lines);
  }
}

CloudDrawing::CloudDrawing()
    : program_(opengl::make_program({.vertex = {shader_text("coloured.vert.glsl")},
                                     .fragment = {shader_text("coloured.frag.glsl")},
                                     .macros = {}})) {}

void CloudDrawing::fill(std::span<const ColouredVertex> vertices, Corners& corners) {
  corners.count = static_cast<GLsizei>(vertices.size());
  glBindVertexArray(corners.arrays.name());
  glBindBuffer(GL_ARRAY_BUFFER, corners.buffer.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size_bytes()), vertices.data(),
               GL_DYNAMIC_DRAW);
  constexpr GLsizei kStride = sizeof(ColouredVertex);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kStride, nullptr);
  glEnableVertexAttribArray(0);
  // OpenGL takes an offset as a pointer
  glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride,
                        static_cast<const char*>(nullptr) + offsetof(ColouredVertex, colour));
  glEnableVertexAttribArray(1);
  glBindVertexArray(0);
}

void CloudDrawing::set_points(std::span<const ColouredVertex> points) {
  fill(points, points_);
}

void CloudDrawing::set_lines(std::span<const ColouredVertex> lines) {
  fill(lines, lines_);
}

void CloudDrawing::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width;
  height_ = height;
  glBindTexture(GL_TEXTURE_2D, picture_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glBindRenderbuffer(GL_RENDERBUFFER, depths_.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture_.name(), 0);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depths_.name());
}

void CloudDrawing::draw(const CloudView& style) {
  constexpr std::array<GLfloat, 4> kBackground = {0.09F, 0.09F, 0.11F, 1.0F};
  constexpr GLfloat kFarthest = 1.0F;
  resize(style.width, style.height);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.name());
  glViewport(0, 0, style.width, style.height);
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  glClearBufferfv(GL_COLOR, 0, kBackground.data());
  glClearBufferfv(GL_DEPTH, 0, &kFarthest);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glUseProgram(program_.name());
  glUniformMatrix4fv(glGetUniformLocation(program_.name(), "clip_from_anchor"), 1, GL_FALSE,
                     style.clip_from_anchor.data());
  glUniform1f(glGetUniformLocation(program_.name(), "point_size"), style.point_size);
  glBindVertexArray(points_.arrays.name());
  glDrawArrays(GL_POINTS, 0, points_.count);
  glBindVertexArray(lines_.arrays.name());
  glDrawArrays(GL_LINES, 0, lines_.count);
  glBindVertexArray(0);
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  opengl::check_gl("drawing the cloud");
}

}  // namespace glidar::app
