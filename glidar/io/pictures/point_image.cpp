// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/point_image.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/pictures/colour_scale.hpp>
#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace glidar {
namespace {

constexpr Colour kNothing = {150, 150, 156};  // returns of no object, and objects without a class

/// Without the darkest colours, which are invisible on the background.
Colour bright_ramp(double t) {
  constexpr double kDarkest = 0.18;
  return viridis(kDarkest + (1.0 - kDarkest) * t);
}

Colour near_bright_ramp(double t) {
  return bright_ramp(1.0 - t);
}

/// Blue, white at the middle, red; all are bright enough for the background.
Colour diverging_ramp(double t) {
  constexpr std::array<Colour, 3> kColours = {{{64, 140, 255}, {232, 232, 236}, {255, 84, 56}}};
  const double place = 2.0 * std::clamp(t, 0.0, 1.0);
  const std::size_t below = place < 1.0 ? 0 : 1;
  const double part = place - static_cast<double>(below);
  const auto mix = [part](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + (b - a) * part));
  };
  const Colour& a = kColours.at(below);
  const Colour& b = kColours.at(below + 1);
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

/// The value of a column for each shown point.
std::vector<double> field_values(const CloudFile& job, const ShownPoints& shown,
                                 std::string_view column) {
  std::vector<double> numbers;
  numbers.reserve(shown.entries.size());
  std::visit(
      [&](const auto& values) {
        for (const std::size_t entry : shown.entries)
          numbers.push_back(static_cast<double>(values[entry]));
      },
      find_column(job.cloud, column)->values);
  return numbers;
}

PointColours colour_by_bar(const std::vector<double>& values, ColourBar bar) {
  PointColours result;
  for (const double value : values) {
    result.colours.push_back(std::isfinite(value) ? bar.ramp(bar.scale.fraction(value)) : kNothing);
  }
  result.bar = std::move(bar);
  return result;
}

/// The scale has 0 in its middle.
PointColours colour_by_velocity(const CloudFile& job, const ShownPoints& shown) {
  if (!job.context.sensor.doppler) {
    throw Error({"colour_by", "radial_velocity: the sensor does not measure it",
                 "height, range, intensity, ring, class or instance",
                 "add 'doppler: {}' to a sensor file (docs/doppler.md)"});
  }
  const std::vector<double> values = field_values(job, shown, "radial_velocity");
  ColourScale scale = make_colour_scale(values);
  const double end = std::max(std::abs(scale.low), std::abs(scale.high));
  scale.clips_low = std::any_of(values.begin(), values.end(), [end](double v) { return v < -end; });
  scale.clips_high = std::any_of(values.begin(), values.end(), [end](double v) { return v > end; });
  scale.low = -end;
  scale.high = end;
  return colour_by_bar(values, {"radial velocity", "m/s", scale, diverging_ramp});
}

PointColours colour_by_ring(const CloudFile& job, const ShownPoints& shown) {
  if (looks_along_z(job.context.beams)) {
    throw Error({"colour_by", "ring: a camera has no rings",
                 "height, range, intensity, class or instance", "rings are channels of LiDARs"});
  }
  const std::vector<double> rings = field_values(job, shown, "ring");
  ColourScale scale{};  // rings have no outliers
  if (!rings.empty()) {
    const auto [low, high] = std::minmax_element(rings.begin(), rings.end());
    scale = {.low = *low, .high = *high, .has_values = true};
  }
  return colour_by_bar(rings, {"ring", "", scale, bright_ramp});
}

std::string class_name(const Scene& scene, std::uint32_t id) {
  return id < scene.class_names.size() ? scene.class_names[id] : fmt::format("class {}", id);
}

std::string instance_name(const Scene& scene, std::uint32_t id) {
  const auto found = std::find_if(scene.instances.begin(), scene.instances.end(),
                                  [id](const Instance& it) { return it.id == id; });
  return found == scene.instances.end() || found->name.empty() ? fmt::format("instance {}", id)
                                                               : found->name;
}

/// Numbers with their names, the most frequent first.
std::vector<LegendEntry> legend_of(const std::map<std::uint32_t, std::size_t>& counts,
                                   const std::map<std::uint32_t, LegendEntry>& entries) {
  std::vector<std::pair<std::uint32_t, std::size_t>> order(counts.begin(), counts.end());
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<LegendEntry> legend;
  for (const auto& [number, count] : order) legend.push_back(entries.at(number));
  return legend;
}

/// The legend entry of a number in the column.
LegendEntry entry_of(const Scene& scene, std::uint32_t number, bool is_class) {
  if (number == kInvalidId) return {kNothing, "no object"};
  if (!is_class) return {category_colour(number), instance_name(scene, number)};
  // number 0 means no class
  return {number == 0 ? kNothing : category_colour(number - 1), class_name(scene, number)};
}

PointColours colour_by_number(const CloudFile& job, const ShownPoints& shown, bool is_class) {
  std::map<std::uint32_t, std::size_t> counts;
  std::map<std::uint32_t, LegendEntry> entries;
  PointColours result;
  for (const double value : field_values(job, shown, is_class ? "class" : "instance")) {
    const auto number = static_cast<std::uint32_t>(value);
    if (counts[number]++ == 0) entries[number] = entry_of(job.context.scene, number, is_class);
    result.colours.push_back(entries[number].colour);
  }
  result.legend = legend_of(counts, entries);
  return result;
}

}  // namespace

PointColours colour_points(const CloudFile& job, const ShownPoints& shown) {
  switch (job.options.picture.colour_by) {
    case ColourBy::range: {
      const std::vector<double> values = field_values(job, shown, "range");
      return colour_by_bar(values, {"range", "m", make_colour_scale(values), near_bright_ramp});
    }
    case ColourBy::intensity: {
      const std::vector<double> values = field_values(job, shown, "intensity");
      return colour_by_bar(
          values,
          {"intensity", "", make_colour_scale(values, ColourScale::Start::zero), light_grey});
    }
    case ColourBy::ring:
      return colour_by_ring(job, shown);
    case ColourBy::object_class:
      return colour_by_number(job, shown, true);
    case ColourBy::instance:
      return colour_by_number(job, shown, false);
    case ColourBy::radial_velocity:
      return colour_by_velocity(job, shown);
    case ColourBy::height:
      break;
  }
  std::vector<double> heights_m;
  for (const Eigen::Vector3d& point : shown.points_m) heights_m.push_back(point.z());
  return colour_by_bar(heights_m, {"height", "m", make_colour_scale(heights_m), bright_ramp});
}

namespace {

constexpr double kNearest_m = 1e-3;  ///< near plane

/// Points p with normal.dot(p) >= offset are on the side that is kept.
struct Plane {
  Eigen::Vector3d normal;
  double offset = 0.0;

  [[nodiscard]] double height(const Eigen::Vector3d& p) const { return normal.dot(p) - offset; }
};

/// The planes through the camera and the centres of the image's outermost pixels.
std::array<Plane, 4> sides_of(const RectifiedCamera& camera) {
  return {{{{camera.fx, 0.0, camera.cx}},
           {{-camera.fx, 0.0, camera.width - 1.0 - camera.cx}},
           {{0.0, camera.fy, camera.cy}},
           {{0.0, -camera.fy, camera.height - 1.0 - camera.cy}}}};
}

/// Vertices of a convex polygon, and a buffer for the clipped one.
struct Polygon {
  std::vector<Eigen::Vector3d> corners;
  std::vector<Eigen::Vector3d> next;
};

/// Clips the polygon at a plane (Sutherland and Hodgman 1974).
void clip(Polygon& polygon, const Plane& plane) {
  polygon.next.clear();
  for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
    const Eigen::Vector3d& a = polygon.corners[i];
    const Eigen::Vector3d& b = polygon.corners[(i + 1) % polygon.corners.size()];
    const double above_a = plane.height(a);
    const double above_b = plane.height(b);
    if (above_a >= 0.0) polygon.next.push_back(a);
    if ((above_a >= 0.0) != (above_b >= 0.0))
      polygon.next.push_back(a + (b - a) * (above_a / (above_a - above_b)));
  }
  std::swap(polygon.corners, polygon.next);
}

void extend(Eigen::AlignedBox2d& box, const Polygon& polygon, const RectifiedCamera& camera) {
  for (const Eigen::Vector3d& p : polygon.corners) {
    box.extend(Eigen::Vector2d(camera.fx * p.x() / p.z() + camera.cx,
                               camera.fy * p.y() / p.z() + camera.cy));
  }
}

/// The fraction of a box that an inner box does not cover; for a flat box, of its length.
double share_outside(const Eigen::AlignedBox2d& whole, const Eigen::AlignedBox2d& inside) {
  double covered = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double length = whole.sizes()[axis];
    if (length > 0.0) covered *= inside.sizes()[axis] / length;
  }
  return 1.0 - covered;
}

}  // namespace

std::optional<ImageBox> image_box(const PlacedMesh& placed, const RectifiedCamera& camera) {
  const Plane front{Eigen::Vector3d::UnitZ(), kNearest_m};
  const std::array<Plane, 4> sides = sides_of(camera);
  Eigen::AlignedBox2d whole;
  Eigen::AlignedBox2d inside;
  Polygon polygon;
  for (const Triangle& triangle : placed.mesh.triangles) {
    polygon.corners.clear();
    for (const std::uint32_t corner : triangle) polygon.corners.push_back(placed.in_camera(corner));
    clip(polygon, front);
    extend(whole, polygon, camera);
    for (const Plane& side : sides) clip(polygon, side);
    extend(inside, polygon, camera);
  }
  if (inside.isEmpty()) return std::nullopt;
  // clipped vertices may be outside by rounding
  const Eigen::Vector2d last(camera.width - 1.0, camera.height - 1.0);
  inside.min() = inside.min().cwiseMax(0.0).cwiseMin(last);
  inside.max() = inside.max().cwiseMax(0.0).cwiseMin(last);
  return ImageBox{inside, share_outside(whole, inside)};
}

namespace {

constexpr double kHalfView = 0.4142135623730951;  // tan of half the vertical field of view, 45 deg

PointImage make_image(std::size_t width, std::size_t height) {
  return {width, height, std::vector(width * height, PointImage::kNoPoint),
          std::vector(width * height, std::numeric_limits<double>::infinity()), 0};
}

/// Draws a square of pixels where no nearer point was drawn.
struct Dot {
  double x;
  double y;
  double depth;
  std::int64_t size;
};

void draw_dot(PointImage& image, const Dot& dot, std::uint32_t point) {
  const auto width = static_cast<std::int64_t>(image.width);
  const auto height = static_cast<std::int64_t>(image.height);
  const auto left = static_cast<std::int64_t>(std::floor(dot.x)) - (dot.size - 1) / 2;
  const auto top = static_cast<std::int64_t>(std::floor(dot.y)) - (dot.size - 1) / 2;
  for (std::int64_t y = std::max<std::int64_t>(top, 0); y < std::min(top + dot.size, height); ++y) {
    for (std::int64_t x = std::max<std::int64_t>(left, 0); x < std::min(left + dot.size, width);
         ++x) {
      const auto pixel = static_cast<std::size_t>(y * width + x);
      if (dot.depth >= image.depths[pixel]) continue;  // the first of equal depths is kept
      image.depths[pixel] = dot.depth;
      image.points[pixel] = point;
    }
  }
}

/// The size of dots that would cover this fraction of the image if evenly distributed.
double dot_side(const PointImage& image, std::size_t points, double share) {
  const double pixels = static_cast<double>(image.points.size());
  return std::sqrt(share * pixels / static_cast<double>(std::max<std::size_t>(points, 1)));
}

bool is_within(const PointImage& image, double x, double y) {
  return x >= 0.0 && y >= 0.0 && x < static_cast<double>(image.width) &&
         y < static_cast<double>(image.height);
}

/// The range of the points along an axis, without outliers.
std::array<double, 2> middle_of(std::span<const Eigen::Vector3d> points_m, Eigen::Index axis) {
  constexpr double kLeftOut = 0.05;  // fraction omitted at each end
  std::vector<double> values;
  values.reserve(points_m.size());
  for (const Eigen::Vector3d& point : points_m) values.push_back(point[axis]);
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return {values[static_cast<std::size_t>(kLeftOut * last)],
          values[static_cast<std::size_t>(std::ceil((1.0 - kLeftOut) * last))]};
}

struct ViewAxes {
  Eigen::Vector3d ahead;
  Eigen::Vector3d right;
  Eigen::Vector3d down;
};

ViewAxes axes_along(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d ahead = direction.normalized();
  Eigen::Vector3d right = ahead.cross(Eigen::Vector3d::UnitZ());
  if (right.norm() < 1e-9) right = -Eigen::Vector3d::UnitY();  // vertical view: x is up
  right.normalize();
  return {ahead, right, ahead.cross(right)};
}

}  // namespace

TopView fit_top_view(std::span<const Eigen::Vector3d> points_m, const Eigen::Vector3d& also_m,
                     double shape) {
  std::vector<double> x;
  std::vector<double> y;
  for (const Eigen::Vector3d& point : points_m) {
    x.push_back(point.x());
    y.push_back(point.y());
  }
  ColourScale across = make_colour_scale(x);
  ColourScale upright = make_colour_scale(y);
  if (!across.has_values) across.low = across.high = also_m.x();
  if (!upright.has_values) upright.low = upright.high = also_m.y();
  const Eigen::Vector2d low(std::min(across.low, also_m.x()), std::min(upright.low, also_m.y()));
  const Eigen::Vector2d high(std::max(across.high, also_m.x()), std::max(upright.high, also_m.y()));
  constexpr double kMargin = 1.04;
  const double min_side_m = points_m.empty() ? 2.0 : 0.1;
  const double width = std::max(
      {kMargin * (high.x() - low.x()), kMargin * shape * (high.y() - low.y()), min_side_m});
  const Eigen::Vector2d middle = 0.5 * (low + high);
  const Eigen::Vector2d half(0.5 * width, 0.5 * width / shape);
  return {middle.x() - half.x(), middle.x() + half.x(), middle.y() - half.y(),
          middle.y() + half.y()};
}

PointImage draw_top_view(std::span<const Eigen::Vector3d> points_m, const TopView& view,
                         std::size_t width, std::size_t height) {
  PointImage image = make_image(width, height);
  const double scale = static_cast<double>(width) / (view.right_m - view.left_m);
  const std::int64_t size =
      std::lround(std::clamp(dot_side(image, points_m.size(), 0.15), 2.0, 5.0));
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const double x = scale * (points_m[i].x() - view.left_m);
    const double y = scale * (view.top_m - points_m[i].y());
    if (!is_within(image, x, y)) {
      ++image.outside;
      continue;
    }
    draw_dot(image, {x, y, -points_m[i].z(), size}, static_cast<std::uint32_t>(i));
  }
  return image;
}

Eigen::Vector3d Perspective::project(const Eigen::Vector3d& point_m) const {
  const ViewAxes axes = axes_along(target_m - eye_m);
  const Eigen::Vector3d from_eye = point_m - eye_m;
  const double depth = axes.ahead.dot(from_eye);
  const double scale = 0.5 * static_cast<double>(height) / kHalfView / depth;
  return {0.5 * static_cast<double>(width) + scale * axes.right.dot(from_eye),
          0.5 * static_cast<double>(height) + scale * axes.down.dot(from_eye), depth};
}

Perspective fit_perspective(std::span<const Eigen::Vector3d> points_m, std::size_t width,
                            std::size_t height) {
  Eigen::AlignedBox3d box;
  if (points_m.empty()) {
    box.extend(Eigen::Vector3d::Constant(-1.0));
    box.extend(Eigen::Vector3d::Constant(1.0));
  }
  for (Eigen::Index axis = 0; axis < 3 && !points_m.empty(); ++axis) {
    const auto [low, high] = middle_of(points_m, axis);
    box.min()[axis] = low;
    box.max()[axis] = high;
  }
  const Eigen::Vector3d ahead = Eigen::Vector3d(0.8, 0.5, -0.55).normalized();
  const ViewAxes axes = axes_along(ahead);
  const double shape = static_cast<double>(width) / static_cast<double>(height);
  double distance_m = 1e-3;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d corner =
        box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k)) - box.center();
    const double along = axes.ahead.dot(corner);
    distance_m =
        std::max({distance_m, std::abs(axes.right.dot(corner)) / (shape * kHalfView) - along,
                  std::abs(axes.down.dot(corner)) / kHalfView - along});
  }
  constexpr double kMargin = 1.08;  // for points at the border and the size of dots
  return {box.center() - kMargin * distance_m * ahead, box.center(), width, height};
}

PointImage draw_perspective(std::span<const Eigen::Vector3d> points_m, const Perspective& view) {
  PointImage image = make_image(view.width, view.height);
  const double typical_m = (view.target_m - view.eye_m).norm();
  const double even = dot_side(image, points_m.size(), 0.3);
  const double side = std::clamp(even, 1.5, 4.0);
  const double smallest = even < 1.0 ? 1.0 : 2.0;  // dense clouds need no larger dots
  constexpr double kMax = 7.0;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector3d place = view.project(points_m[i]);
    if (!(place.z() > 0.0) || !is_within(image, place.x(), place.y())) {
      ++image.outside;
      continue;
    }
    const double size = std::clamp(side * typical_m / place.z(), smallest, kMax);
    draw_dot(image, {place.x(), place.y(), place.z(), std::lround(size)},
             static_cast<std::uint32_t>(i));
  }
  return image;
}

std::vector<double> shade_edges(const PointImage& image) {
  constexpr double kStrength = 12.0;
  constexpr double kDarkest = 0.35;
  constexpr double kSteps = 16.0;  // finer steps are invisible and nearly double the file size
  const auto width = static_cast<std::int64_t>(image.width);
  const auto height = static_cast<std::int64_t>(image.height);
  const std::int64_t reach = std::max<std::int64_t>(1, width / 1000);
  std::vector<double> shades(image.points.size(), 1.0);
  for (std::int64_t i = 0; i < width * height; ++i) {
    const auto pixel = static_cast<std::size_t>(i);
    if (image.points[pixel] == PointImage::kNoPoint) continue;
    double sum = 0.0;
    for (int k = 0; k < 8; ++k) {
      constexpr std::array<int, 8> kAcross = {-1, 0, 1, -1, 1, -1, 0, 1};
      constexpr std::array<int, 8> kDown = {-1, -1, -1, 0, 0, 1, 1, 1};
      const std::int64_t x = i % width + reach * kAcross.at(static_cast<std::size_t>(k));
      const std::int64_t y = i / width + reach * kDown.at(static_cast<std::size_t>(k));
      if (x < 0 || y < 0 || x >= width || y >= height) continue;
      const double before = image.depths[static_cast<std::size_t>(y * width + x)];
      if (std::isinf(before)) continue;
      sum += std::max(0.0, portable_log2(image.depths[pixel] / before));
    }
    const double shade = kDarkest + (1.0 - kDarkest) * portable_exp(-kStrength * sum);
    shades[pixel] = std::round(kSteps * shade) / kSteps;
  }
  return shades;
}

}  // namespace glidar
