// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/format.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/pictures/chart.hpp>
#include <glidar/io/pictures/picture.hpp>
#include <glidar/io/pictures/point_image.hpp>
#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace glidar {
namespace {

/// A cloud prepared for drawing.
struct CloudScene {
  ShownPoints shown;
  PointColours colours;
  Eigen::Matrix3d up_from_cloud;
  Eigen::Vector3d sensor_m;  ///< in the frame with z up
  Eigen::Vector3d ahead;     ///< boresight of the sensor, in the same frame
};

/// Rotates the cloud so that z is up: the world frame is unchanged; others are sensor frames,
/// which become x forward, y left, z up.
Eigen::Matrix3d up_from_cloud(const CloudFile& job) {
  if (job.cloud.frame_id == "world") return Eigen::Matrix3d::Identity();
  const SensorAxes axes = axes_of(job.context.beams);
  Eigen::Matrix3d up_from_sensor;
  up_from_sensor << axes.ahead.transpose(), axes.left.transpose(), axes.up.transpose();
  return up_from_sensor * job.frame.world_from_sensor.linear().transpose() *
         job.cloud.world_from_cloud.linear();
}

CloudScene scene_of(const CloudFile& job) {
  const PointCloud& cloud = job.cloud;
  CloudScene scene{};
  scene.up_from_cloud = up_from_cloud(job);
  const auto& xyz = std::get<std::vector<double>>(find_column(cloud, "xyz")->values);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d point(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
    if (!point.allFinite()) continue;
    scene.shown.points_m.push_back(scene.up_from_cloud * point);
    scene.shown.entries.push_back(i);
  }
  scene.colours = colour_points(job, scene.shown);
  const Pose cloud_from_sensor = cloud.world_from_cloud.inverse() * job.frame.world_from_sensor;
  scene.sensor_m = scene.up_from_cloud * cloud_from_sensor.translation();
  scene.ahead =
      scene.up_from_cloud * (cloud_from_sensor.linear() * axes_of(job.context.beams).ahead);
  return scene;
}

/// Layout of the picture, in pixels.
struct PictureLayout {
  double letters;
  Box plot;
  Box key;                          ///< of the bar or the legend
  std::vector<LegendEntry> legend;  ///< those that have room
};

PictureLayout make_layout(const CloudPictureOptions& options, const PointColours& colours,
                          bool has_axes) {
  PictureLayout layout{};
  const auto width = static_cast<double>(options.width);
  layout.letters = std::max(10.0, width / 75.0);
  const double gap = layout.letters;
  const double left = has_axes ? upright_axis_width(layout.letters) : gap;
  const double top = has_axes ? 2.2 * layout.letters : gap;
  const double axis = has_axes ? across_axis_height(layout.letters) : 0.0;
  const double key_width = width - left - gap;
  constexpr double kMaxLegend = 0.3;  // of the height
  layout.legend =
      fitted_legend(colours.legend, key_width, kMaxLegend * options.height, layout.letters);
  const double key = colours.bar ? colour_bar_height(layout.letters)
                                 : legend_height(layout.legend, key_width, layout.letters);
  const double plot = std::max(16.0, options.height - top - axis - key - 2.0 * gap);
  const auto pixels = [](double length) { return static_cast<std::size_t>(std::max(1.0, length)); };
  layout.plot = {pixels(left), pixels(top), pixels(key_width), pixels(plot)};
  layout.key = {pixels(left), pixels(top + plot + axis + gap), pixels(key_width), pixels(key)};
  return layout;
}

void draw_key(Picture& picture, const PictureLayout& layout, const PointColours& colours) {
  if (colours.bar) {
    const std::size_t inset = layout.key.width / 6;  // the bar is narrower than the plot
    draw_colour_bar(
        picture,
        {layout.key.x + inset, layout.key.y, layout.key.width - 2 * inset, layout.key.height},
        *colours.bar, layout.letters);
  } else {
    draw_legend(picture, layout.key, layout.legend, layout.letters);
  }
}

Colour darkened(const Colour& colour, double share) {
  const auto channel = [share](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::lround(share * value));
  };
  return {channel(colour.r), channel(colour.g), channel(colour.b)};
}

/// Each pixel in the colour of its point, multiplied by `shades` (empty: 1).
void draw_points(Picture& picture, const Box& plot, const PointImage& image,
                 const std::vector<Colour>& colours, const std::vector<double>& shades) {
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    if (image.points[i] == PointImage::kNoPoint) continue;
    const std::size_t x = plot.x + i % image.width;
    const std::size_t y = plot.y + i / image.width;
    const Colour& colour = colours[image.points[i]];
    fill(picture, {x, y, 1, 1}, shades.empty() ? colour : darkened(colour, shades[i]));
  }
}

/// A line of text in the lower right corner of the plot, on its own background.
void draw_note(Picture& picture, const PictureLayout& layout, const std::string& note) {
  if (note.empty()) return;
  const Box& plot = layout.plot;
  const double size_px = 0.9 * layout.letters;
  const auto width = static_cast<std::size_t>(text_width(note, size_px) + size_px);
  const auto height = static_cast<std::size_t>(1.7 * size_px);
  const Box ground{plot.x + plot.width - std::min(width, plot.width),
                   plot.y + plot.height - std::min(height, plot.height), width, height};
  fill(picture, ground, kCanvas);
  draw_text(
      picture,
      {static_cast<double>(ground.x) + 0.5 * static_cast<double>(width),
       static_cast<double>(ground.y) + 0.5 * static_cast<double>(height), TextPlace::Align::centre},
      note, {size_px, kInk});
}

std::string outside_text(const PointImage& image, std::size_t points) {
  if (points == 0) return "no returns";
  if (image.outside == 0) return "";
  return fmt::format("{} of {} points are outside", image.outside, points);
}

Picture draw_bird_eye(const CloudFile& job) {
  const CloudScene scene = scene_of(job);
  const PictureLayout layout = make_layout(job.options.picture, scene.colours, true);
  const Box& plot = layout.plot;
  const double shape = static_cast<double>(plot.width) / static_cast<double>(plot.height);
  const TopView view = fit_top_view(scene.shown.points_m, scene.sensor_m, shape);
  const PointImage image = draw_top_view(scene.shown.points_m, view, plot.width, plot.height);
  Picture picture = make_picture(job.options.picture.width, job.options.picture.height, kCanvas);
  fill(picture, plot, kPlotGround);
  const PlotAxis across{"x, m", view.left_m, view.right_m};
  const std::vector<AxisLabel> upright = axis_labels(
      {"", view.top_m, view.bottom_m}, static_cast<double>(plot.height), 3.0 * layout.letters);
  draw_grid(picture, plot,
            axis_labels(across, static_cast<double>(plot.width), 5.0 * layout.letters), upright);
  draw_points(picture, plot, image, scene.colours.colours, {});
  draw_across_axis(picture, plot, across, layout.letters);
  draw_upright_axis(picture, plot, "y, m", upright, layout.letters);
  const double scale = static_cast<double>(plot.width) / (view.right_m - view.left_m);
  draw_sensor(picture, plot,
              {static_cast<double>(plot.x) + scale * (scene.sensor_m.x() - view.left_m),
               static_cast<double>(plot.y) + scale * (view.top_m - scene.sensor_m.y()),
               scene.ahead.x(), -scene.ahead.y()},
              0.7 * layout.letters);
  draw_note(picture, layout, outside_text(image, scene.shown.points_m.size()));
  draw_key(picture, layout, scene.colours);
  return picture;
}

Perspective view_of(const CloudFile& job, const CloudScene& scene, const Box& plot) {
  const CloudPictureOptions& options = job.options.picture;
  Perspective view = fit_perspective(scene.shown.points_m, plot.width, plot.height);
  if (options.target_m) view.target_m = scene.up_from_cloud * *options.target_m;
  if (options.eye_m) view.eye_m = scene.up_from_cloud * *options.eye_m;
  if ((view.target_m - view.eye_m).norm() > 0.0) return view;
  throw Error({"view_eye", "it equals the view's target", "a point other than view_target"});
}

/// A grid of lines on the ground below the points.
struct GroundGrid {
  double height_m;
  double step_m;
  Eigen::Vector2d middle_m;
};

GroundGrid grid_of(const CloudScene& scene, const Perspective& view) {
  std::vector<double> heights_m;
  for (const Eigen::Vector3d& point : scene.shown.points_m) heights_m.push_back(point.z());
  const ColourScale heights = make_colour_scale(heights_m);
  const double extent_m = (view.target_m - view.eye_m).norm();
  const double power = power_of_ten(decimal_exponent(0.2 * extent_m));
  const double digits = 0.2 * extent_m / power;
  const double factor = digits >= 5.0 ? 5.0 : digits >= 2.0 ? 2.0 : 1.0;
  return {heights.low, factor * power, view.target_m.head<2>()};
}

/// A line as dense dots, behind all points.
void draw_line(Picture& picture, const Box& plot, const Perspective& view, const PointImage& image,
               const std::array<Eigen::Vector3d, 2>& ends) {
  constexpr int kDots = 4000;
  for (int i = 0; i <= kDots; ++i) {
    const Eigen::Vector3d at = ends[0] + (ends[1] - ends[0]) * (i / double{kDots});
    const Eigen::Vector3d place = view.project(at);
    if (!(place.z() > 0.0)) continue;
    const double x = std::floor(place.x());
    const double y = std::floor(place.y());
    if (x < 0.0 || y < 0.0 || x >= static_cast<double>(plot.width) ||
        y >= static_cast<double>(plot.height))
      continue;
    const auto col = static_cast<std::size_t>(x);
    const auto row = static_cast<std::size_t>(y);
    if (image.points[row * image.width + col] != PointImage::kNoPoint) continue;
    fill(picture, {plot.x + col, plot.y + row, 1, 1}, kGridLine);
  }
}

void draw_ground(Picture& picture, const Box& plot, const Perspective& view,
                 const PointImage& image, const GroundGrid& grid) {
  constexpr int kLines = 12;  // in each direction
  const double x = std::round(grid.middle_m.x() / grid.step_m);
  const double y = std::round(grid.middle_m.y() / grid.step_m);
  const auto corner = [&](double i, double j) {
    return Eigen::Vector3d(grid.step_m * (x + i), grid.step_m * (y + j), grid.height_m);
  };
  for (int i = -kLines; i <= kLines; ++i) {
    draw_line(picture, plot, view, image, {corner(i, -kLines), corner(i, kLines)});
    draw_line(picture, plot, view, image, {corner(-kLines, i), corner(kLines, i)});
  }
}

Picture draw_view(const CloudFile& job) {
  const CloudScene scene = scene_of(job);
  const PictureLayout layout = make_layout(job.options.picture, scene.colours, false);
  const Box& plot = layout.plot;
  const Perspective view = view_of(job, scene, plot);
  const PointImage image = draw_perspective(scene.shown.points_m, view);
  const GroundGrid grid = grid_of(scene, view);
  Picture picture = make_picture(job.options.picture.width, job.options.picture.height, kCanvas);
  draw_ground(picture, plot, view, image, grid);
  draw_points(picture, plot, image, scene.colours.colours, shade_edges(image));
  const Eigen::Vector3d sensor = view.project(scene.sensor_m);
  if (sensor.z() > 0.0) {
    draw_sensor(picture, plot,
                {static_cast<double>(plot.x) + sensor.x(), static_cast<double>(plot.y) + sensor.y(),
                 0.0, 0.0},
                0.7 * layout.letters);
  }
  const std::string outside = outside_text(image, scene.shown.points_m.size());
  draw_note(picture, layout,
            fmt::format("grid {} m{}{}", scale_number(grid.step_m, grid.step_m),
                        outside.empty() ? "" : ", ", outside));
  draw_key(picture, layout, scene.colours);
  return picture;
}

/// The columns that write_bird_eye and write_perspective need.
std::vector<std::string> cloud_picture_columns() {
  return {"xyz", "range", "intensity", "ring", "class", "instance", "radial_velocity"};
}

/// Writes a picture of the cloud from above, x to the right and y up, with axes, coloured by
/// options.picture; the highest point is visible. The cloud is rotated so that z is up.
/// Throws Error when a camera's cloud is to be coloured by ring.
void write_bird_eye(const CloudFile& job, AtomicFile& file) {
  write_png(draw_bird_eye(job), "the cloud from above", file);
}

/// The same in perspective, with a grid on the ground; the nearest point is visible. Also throws
/// Error when the eye is at the target.
void write_perspective(const CloudFile& job, AtomicFile& file) {
  write_png(draw_view(job), "the cloud in perspective", file);
}

Misfit cloud_picture_misfit(const CloudPictureOptions& picture, const Sensor& sensor,
                            const Beams& /*beams*/) {
  if (picture.colour_by == ColourBy::radial_velocity && !sensor.doppler) {
    return {
        "the sensor measures no radial velocity to colour by",
        "colour by something else (--colour-by, colour_by in Python), or add 'doppler: {}' to a "
        "sensor file"};
  }
  const bool is_camera = std::holds_alternative<Pinhole>(sensor.optics);
  if (!is_camera || picture.colour_by != ColourBy::ring) return {};
  return {"a camera has no rings to colour by",
          "colour by something else (--colour-by, colour_by in Python)"};
}

}  // namespace

Format bird_eye_format() {
  return {.info = {.suffix = ".bev.png",
                   .description = "picture of the cloud from above",
                   .columns = cloud_picture_columns()},
          .content = Content::per_beam,
          .write = write_bird_eye,
          .misfit = cloud_picture_misfit};
}

Format perspective_format() {
  return {.info = {.suffix = ".view.png",
                   .description = "picture of the cloud in perspective",
                   .columns = cloud_picture_columns()},
          .content = Content::per_beam,
          .write = write_perspective,
          .misfit = cloud_picture_misfit};
}

}  // namespace glidar
