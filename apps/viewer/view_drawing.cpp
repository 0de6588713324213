// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/view_drawing.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/render/opengl/gl_object.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

namespace glidar::app {
namespace {

Eigen::Vector3d to_eye(const Orbit& orbit) {
  return {portable_cos(orbit.pitch_rad) * portable_cos(orbit.yaw_rad),
          portable_cos(orbit.pitch_rad) * portable_sin(orbit.yaw_rad),
          portable_sin(orbit.pitch_rad)};
}

double half_height() {
  return portable_tan(kOrbitFov_rad / 2.0);
}

}  // namespace

void turn(Orbit& orbit, const Eigen::Vector2d& drag) {
  constexpr double kSteepest =
      std::numbers::pi / 2.0 - 1e-3;  // the view direction must not be vertical
  orbit.yaw_rad =
      std::remainder(orbit.yaw_rad - std::numbers::pi * drag.x(), 2.0 * std::numbers::pi);
  orbit.pitch_rad =
      std::clamp(orbit.pitch_rad + std::numbers::pi * drag.y(), -kSteepest, kSteepest);
}

void pan(Orbit& orbit, const Eigen::Vector2d& drag) {
  const double height_m = 2.0 * half_height() * orbit.distance_m;
  const Eigen::Matrix3d axes = anchor_from_eye(orbit).linear();
  orbit.pivot_m -= height_m * (drag.x() * axes.col(0) + drag.y() * axes.col(1));
}

void zoom(Orbit& orbit, double steps) {
  constexpr double kNearest_m = 1e-6;
  constexpr double kFarthest_m = 1e9;
  orbit.distance_m =
      std::clamp(orbit.distance_m * portable_pow(0.9, steps), kNearest_m, kFarthest_m);
}

Pose anchor_from_eye(const Orbit& orbit) {
  return look_at(orbit.pivot_m + orbit.distance_m * to_eye(orbit), orbit.pivot_m,
                 Eigen::Vector3d::UnitZ());
}

Eigen::Matrix4f clip_from_anchor(const Orbit& orbit, double aspect) {
  constexpr double kNear = 1e-3;  // of the distance
  constexpr double kFar = 1e3;
  const double near_m = kNear * orbit.distance_m;
  const double far_m = kFar * orbit.distance_m;
  Eigen::Matrix4d clip_from_eye = Eigen::Matrix4d::Zero();
  clip_from_eye(0, 0) = 1.0 / (aspect * half_height());
  clip_from_eye(1, 1) = -1.0 / half_height();
  clip_from_eye(2, 2) = (far_m + near_m) / (far_m - near_m);
  clip_from_eye(2, 3) = -2.0 * far_m * near_m / (far_m - near_m);
  clip_from_eye(3, 2) = 1.0;
  return (clip_from_eye * anchor_from_eye(orbit).inverse().matrix()).cast<float>();
}

std::optional<std::size_t> point_at(const Orbit& orbit, std::span<const Eigen::Vector3f> points,
                                    const Eigen::Vector2d& place, double reach) {
  const Pose eye_from_anchor = anchor_from_eye(orbit).inverse();
  std::optional<std::size_t> best;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d seen = eye_from_anchor * points[i].cast<double>();
    if (!(seen.z() > 0.0 && seen.z() < nearest_m)) continue;
    const Eigen::Vector2d at(seen.x() / seen.z() / half_height(),
                             -seen.y() / seen.z() / half_height());
    if ((at - place).norm() > 2.0 * reach) continue;
    best = i;
    nearest_m = seen.z();
  }
  return best;
}

namespace {

constexpr double kMargin = 1.1;  // free space around framed objects

/// The distance at which a sphere fits into this half angle.
double distance_to_see(double radius_m, double half_angle_rad) {
  return kMargin * radius_m / portable_sin(half_angle_rad);
}

bool contains(const Orbit& orbit, std::span<const Eigen::Vector3d> points, double aspect) {
  const Pose eye_from_anchor = anchor_from_eye(orbit).inverse();
  const double half_height = portable_tan(kOrbitFov_rad / 2.0);
  return std::all_of(points.begin(), points.end(), [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d seen = eye_from_anchor * point;
    const double reach = half_height * seen.z();
    return std::abs(seen.x()) <= aspect * reach && std::abs(seen.y()) <= reach;
  });
}

}  // namespace

Sphere sphere_around(std::span<const Eigen::Vector3d> corners_m) {
  Sphere sphere;
  if (corners_m.empty()) return sphere;
  for (const Eigen::Vector3d& corner : corners_m) sphere.middle_m += corner;
  sphere.middle_m /= static_cast<double>(corners_m.size());
  for (const Eigen::Vector3d& corner : corners_m) {
    sphere.radius_m = std::max(sphere.radius_m, (corner - sphere.middle_m).norm());
  }
  return sphere;
}

void frame_sphere(Orbit& orbit, const Sphere& anchored, double aspect) {
  constexpr double kMinRadius_m = 1e-6;
  const double half_rad =
      portable_atan(portable_tan(kOrbitFov_rad / 2.0) * std::clamp(aspect, 1e-3, 1.0));
  orbit.pivot_m = anchored.middle_m;
  orbit.distance_m = distance_to_see(std::max(anchored.radius_m, kMinRadius_m), half_rad);
}

void zoom_out_to(Orbit& orbit, std::span<const Eigen::Vector3d> points, double aspect) {
  constexpr int kMaxSteps = 100;  // 0.9^-100: 38,000 times as far
  for (int i = 0; i < kMaxSteps && !contains(orbit, points, aspect); ++i) zoom(orbit, -1.0);
}

Orbit view_of_all(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& sensor_m, double aspect) {
  const double size_m = box.isEmpty() ? 1.0 : box.diagonal().norm();
  const bool is_among = !box.isEmpty() && box.contains(sensor_m);
  Orbit orbit{.pivot_m = 0.45 * sensor_m,
              .yaw_rad = portable_atan2(sensor_m.y(), sensor_m.x()) + 0.9,
              .pitch_rad = 0.45,
              .distance_m = is_among ? 0.5 * size_m : 1.8 * std::max(size_m, sensor_m.norm())};
  std::vector<Eigen::Vector3d> ends_m = {sensor_m};
  for (int corner = 0; corner < 8 && !box.isEmpty(); ++corner) {
    ends_m.emplace_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  }
  zoom_out_to(orbit, ends_m, aspect);
  return orbit;
}

std::optional<FieldOfView> field_of_view(const Beams& beams) {
  constexpr double kMinAhead = 0.1;     // cosine; wider images need no aiming
  constexpr double kMinTangent = 1e-3;  // narrower images cannot contain an object
  FieldOfView field{.axes = axes_of(beams)};
  for (const Eigen::Vector3d& direction : beams.directions) {
    if (std::isnan(direction.x())) continue;
    const double ahead = direction.dot(field.axes.ahead);
    if (ahead < kMinAhead) return std::nullopt;
    const double left = direction.dot(field.axes.left) / ahead;
    const double up = direction.dot(field.axes.up) / ahead;
    field.left = std::max(field.left, left);
    field.right = std::max(field.right, -left);
    field.up = std::max(field.up, up);
    field.down = std::max(field.down, -up);
  }
  const double min_tangent = std::min({field.left, field.right, field.up, field.down});
  return min_tangent < kMinTangent ? std::nullopt : std::optional(field);
}

Visibility visibility(const FieldOfView& field, const Pose& world_from_sensor,
                      std::span<const Eigen::Vector3d> corners_m) {
  const Pose sensor_from_world = world_from_sensor.inverse();
  std::array<std::size_t, 5> beyond{};  // each edge, and behind the sensor
  for (const Eigen::Vector3d& corner : corners_m) {
    const Eigen::Vector3d at = sensor_from_world * corner;
    const double ahead = at.dot(field.axes.ahead);
    const double left = at.dot(field.axes.left);
    const double up = at.dot(field.axes.up);
    beyond[0] += left > field.left * ahead ? 1 : 0;
    beyond[1] += -left > field.right * ahead ? 1 : 0;
    beyond[2] += up > field.up * ahead ? 1 : 0;
    beyond[3] += -up > field.down * ahead ? 1 : 0;
    beyond[4] += ahead <= 0.0 ? 1 : 0;
  }
  const std::size_t max_beyond = *std::max_element(beyond.begin(), beyond.end());
  if (max_beyond == 0) return Visibility::inside;
  return max_beyond == corners_m.size() ? Visibility::outside : Visibility::partly;
}

std::optional<Pose> aimed_at(const FieldOfView& field, const Pose& world_from_sensor,
                             const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d way_m = point_m - world_from_sensor.translation();
  if (way_m.norm() == 0.0) return std::nullopt;
  const Eigen::Vector3d ahead = world_from_sensor.linear() * field.axes.ahead;
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(ahead, way_m);
  return make_pose(world_from_sensor.translation(),
                   turn * Eigen::Quaterniond(world_from_sensor.linear()));
}

std::optional<Pose> pose_to_show(const FieldOfView& field, const Pose& world_from_sensor,
                                 std::span<const Eigen::Vector3d> corners_m) {
  const Visibility now = visibility(field, world_from_sensor, corners_m);
  const Sphere sphere = sphere_around(corners_m);
  const Eigen::Vector3d way_m = sphere.middle_m - world_from_sensor.translation();
  const bool is_among = way_m.norm() <= sphere.radius_m;
  if (now == Visibility::inside || (is_among && now == Visibility::partly)) return std::nullopt;
  std::optional<Pose> pose = aimed_at(field, world_from_sensor, sphere.middle_m);
  if (!pose || is_among || visibility(field, *pose, corners_m) == Visibility::inside) return pose;
  const double tangent = std::min({field.left, field.right, field.up, field.down});
  const double distance_m = distance_to_see(sphere.radius_m, portable_atan(tangent));
  pose->translation() = sphere.middle_m - distance_m * way_m.normalized();
  return pose;
}

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

namespace {

double value_of(const Frame& frame, const Beams& beams, Quantity quantity, std::size_t i) {
  if (frame.status[i] != Status::hit) return std::numeric_limits<double>::quiet_NaN();
  if (quantity == Quantity::intensity) return double{frame.intensity[i]};
  if (quantity == Quantity::depth) return depth_m(beams, i, frame.range_m[i]);
  return frame.range_m[i] + beams.range_offset_m;
}

void colour_by_scale(const Frame& frame, const Beams& beams, Quantity quantity, ColourMap map,
                     SensorPicture& picture) {
  const std::size_t size = frame.status.size();
  const bool is_near_bright = quantity != Quantity::intensity;
  std::vector<double> values;
  values.reserve(size);
  for (std::size_t i = 0; i < size; ++i) values.push_back(value_of(frame, beams, quantity, i));
  picture.scale =
      make_colour_scale(values, quantity == Quantity::intensity ? ColourScale::Start::zero
                                                                : ColourScale::Start::lowest);
  for (std::size_t i = 0; i < size; ++i) {
    if (!std::isfinite(values[i])) continue;
    const double t = picture.scale.fraction(values[i]);
    picture.colours[i] = colour_of(map, is_near_bright ? 1.0 - t : t);
  }
}

/// All returns, one below the other if they have the same width; else the first.
BeamPicture layout_of(const Frame& frame, const Beams& beams) {
  BeamPicture all = make_beam_picture(beams, frame.range_m);
  if (all.kind == BeamPicture::Kind::image) {
    all.rows = beams.rows;  // the beams are in this order already
    return all;
  }
  for (std::uint32_t k = 1; k < beams.returns; ++k) {
    const BeamPicture next = make_beam_picture(beams, frame.range_m, k);
    if (next.cols != all.cols) continue;
    all.beams.insert(all.beams.end(), next.beams.begin(), next.beams.end());
    all.rows += next.rows;
  }
  return all;
}

void colour_by_normal(const Frame& frame, const Beams& beams, SensorPicture& picture) {
  const SensorAxes axes = axes_of(beams);
  Eigen::Matrix3f seen_from_sensor;
  seen_from_sensor << -axes.left.cast<float>().transpose(), axes.up.cast<float>().transpose(),
      -axes.ahead.cast<float>().transpose();
  for (std::size_t i = 0; i < frame.status.size(); ++i) {
    const Eigen::Vector3f& normal = frame.ground_truth.normal[i];
    if (frame.status[i] != Status::hit || std::isnan(normal.x())) continue;
    const Eigen::Vector3f seen = 255.0F * (0.5F * (seen_from_sensor * normal).array() + 0.5F);
    picture.colours[i] = {static_cast<std::uint8_t>(seen.x()), static_cast<std::uint8_t>(seen.y()),
                          static_cast<std::uint8_t>(seen.z())};
  }
  picture.legend = {{{255, 127, 127}, "to the right"},
                    {{127, 255, 127}, "up"},
                    {{127, 127, 255}, "towards the sensor"}};
}

void colour_by_instance(const Frame& frame, const Scene& scene, SensorPicture& picture) {
  std::map<std::uint32_t, bool> seen;
  for (std::size_t i = 0; i < frame.status.size(); ++i) {
    const std::uint32_t instance = frame.ground_truth.instance[i];
    if (frame.status[i] != Status::hit || instance == kInvalidId) continue;
    picture.colours[i] = category_colour(instance);
    seen[instance] = true;
  }
  for (const auto& [instance, is_seen] : seen) {
    const Instance& it = scene.instances[instance];
    picture.legend.push_back(
        {category_colour(instance), it.name + " (id " + std::to_string(it.id) + ")"});
  }
}

void colour_by_status(const Frame& frame, SensorPicture& picture) {
  std::map<Status, std::size_t> counts;
  for (std::size_t i = 0; i < frame.status.size(); ++i) {
    picture.colours[i] = colour_of(frame.status[i]);
    ++counts[frame.status[i]];
  }
  for (const auto& [status, count] : counts) {
    picture.legend.push_back(
        {colour_of(status), std::string(name(status)) + ": " + std::to_string(count)});
  }
}

}  // namespace

bool has_scale(Quantity quantity) {
  return quantity == Quantity::depth || quantity == Quantity::range ||
         quantity == Quantity::intensity;
}

std::string_view unit_of(Quantity quantity) {
  return quantity == Quantity::depth || quantity == Quantity::range ? "m" : "";
}

Colour colour_of(Status status) {
  if (status == Status::hit) return {225, 225, 230};
  if (status == Status::miss) return kNoReturn;
  return category_colour(static_cast<std::uint32_t>(status));
}

void make_sensor_picture(const Frame& frame, const Beams& beams, const Scene& scene,
                         Quantity quantity, ColourMap map, SensorPicture& picture) {
  picture.colours.assign(frame.status.size(), kNoReturn);
  picture.legend.clear();
  picture.layout = layout_of(frame, beams);
  switch (quantity) {
    case Quantity::depth:
    case Quantity::range:
    case Quantity::intensity:
      return colour_by_scale(frame, beams, quantity, map, picture);
    case Quantity::normals:
      return colour_by_normal(frame, beams, picture);
    case Quantity::instance:
      return colour_by_instance(frame, scene, picture);
    case Quantity::status:
      return colour_by_status(frame, picture);
  }
}

}  // namespace glidar::app
