// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/pattern_picture.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/io/pictures/chart.hpp>
#include <glidar/io/pictures/png_image.hpp>
#include <glidar/math/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace glidar {
namespace {

constexpr double kLetters = 18.0;
constexpr std::size_t kWide = 1080;
constexpr std::size_t kTall = 720;
constexpr std::size_t kLeft = 90;  // space for the labels
constexpr std::size_t kTop = 50;
constexpr std::size_t kRight = 40;
constexpr std::size_t kBottom = 160;

/// The direction of a beam in degrees to the left and up, and its value on the colour scale.
struct PatternMark {
  double left_deg;
  double up_deg;
  double value;
};

/// The range of angles along one axis of the plot.
struct PatternSide {
  double low_deg = 0.0;
  double high_deg = 0.0;
  std::size_t pixels = 0;

  [[nodiscard]] double place(double deg) const {
    return (deg - low_deg) / (high_deg - low_deg) * static_cast<double>(pixels - 1);
  }
};

/// Stride of rows and columns of an image, so that dots do not overlap.
std::size_t stride_of(const Beams& beams) {
  constexpr std::size_t kMaxAcross = 64;
  const bool image = beams.times_ns.empty() && beams.rows > 1;
  return image ? std::max<std::size_t>(1, std::max(beams.rows, beams.cols) / kMaxAcross) : 1;
}

/// Without the darkest colours, which are invisible on the background.
Colour mark_colour(double t) {
  constexpr double kDarkest = 0.2;
  return viridis(kDarkest + (1.0 - kDarkest) * t);
}

double value_of(const Beams& beams, std::size_t i) {
  if (!beams.times_ns.empty()) return 1e-6 * beams.times_ns[i];  // milliseconds
  if (!beams.rings.empty()) return beams.rings[i];
  const std::size_t row = i / beams.cols;
  return static_cast<double>(row);
}

std::vector<PatternMark> marks_of(const Beams& beams) {
  const SensorAxes axes = axes_of(beams);
  std::vector<PatternMark> marks;
  const std::size_t step = stride_of(beams);
  for (std::size_t row = 0; row < beams.rows; row += step) {
    for (std::size_t col = 0; col < beams.cols; col += step) {
      const std::size_t i = row * beams.cols + col;
      const Eigen::Vector3d& d = beams.directions[i];
      if (std::isnan(d.x())) continue;
      marks.push_back({kDegreesPerRadian * azimuth_rad(axes, d),
                       kDegreesPerRadian * elevation_rad(axes, d), value_of(beams, i)});
    }
  }
  if (marks.empty()) throw Error({"picture of the beams", "the sensor has no beams"});
  return marks;
}

/// The range of one angle with a margin; a fixed range for a single line.
PatternSide side_of(const std::vector<PatternMark>& marks, double PatternMark::*angle) {
  const auto [low, high] = std::minmax_element(
      marks.begin(), marks.end(),
      [angle](const PatternMark& a, const PatternMark& b) { return a.*angle < b.*angle; });
  const double margin_deg = std::max(0.04 * ((*high).*angle - (*low).*angle), 0.5);
  return {(*low).*angle - margin_deg, (*high).*angle + margin_deg, 0};
}

/// Equal scales along both axes, unless one side is much longer.
void size_sides(PatternSide& across, PatternSide& upright) {
  constexpr double kMaxStretch = 4.0;
  const double width_deg = across.high_deg - across.low_deg;
  const double height_deg = upright.high_deg - upright.low_deg;
  const double scale = std::min(kWide / width_deg, kTall / height_deg);
  const double stretch = std::clamp(0.3 * kWide / (scale * height_deg), 1.0, kMaxStretch);
  across.pixels = static_cast<std::size_t>(std::max(scale * width_deg, 200.0));
  upright.pixels = static_cast<std::size_t>(std::max(scale * stretch * height_deg, 60.0));
}

void draw_axes(Picture& picture, const Box& plot, const PatternSide& across,
               const PatternSide& upright) {
  fill(picture, plot, kPlotGround);
  const PlotAxis azimuth{"azimuth", across.high_deg, across.low_deg,
                         true};  // left in the picture is left of the sensor
  const std::vector<AxisLabel> elevations =
      axis_labels({"", upright.high_deg, upright.low_deg, true}, static_cast<double>(plot.height),
                  2.0 * kLetters);
  draw_grid(picture, plot, axis_labels(azimuth, static_cast<double>(plot.width), 5.0 * kLetters),
            elevations);
  draw_across_axis(picture, plot, azimuth, kLetters);
  draw_upright_axis(picture, plot, "elevation", elevations, kLetters);
}

void draw_marks(Picture& picture, const std::vector<PatternMark>& marks, const Box& plot,
                const std::array<PatternSide, 2>& sides, const ColourScale& scale) {
  const std::size_t size = marks.size() < 20'000 ? 2 : 1;
  const auto& [across, upright] = sides;
  for (const PatternMark& mark : marks) {
    const auto right = static_cast<std::size_t>(std::lround(across.place(mark.left_deg)));
    const auto up = static_cast<std::size_t>(std::lround(upright.place(mark.up_deg)));
    fill(picture, {plot.x + plot.width - 1 - right, plot.y + plot.height - 1 - up, size, size},
         mark_colour(scale.fraction(mark.value)));
  }
}

/// Firing times and rings have no outliers: the scale shows all values.
ColourScale scale_of(const std::vector<PatternMark>& marks) {
  const auto [low, high] = std::minmax_element(
      marks.begin(), marks.end(),
      [](const PatternMark& a, const PatternMark& b) { return a.value < b.value; });
  return {.low = low->value, .high = high->value, .has_values = true};
}

}  // namespace

void write_pattern_picture(const Beams& beams, const std::filesystem::path& path) {
  const std::vector<PatternMark> marks = marks_of(beams);
  std::array sides = {side_of(marks, &PatternMark::left_deg), side_of(marks, &PatternMark::up_deg)};
  size_sides(sides[0], sides[1]);
  constexpr std::size_t kMinWidth = 360;  // for the colour bar
  const std::size_t width = std::max(sides[0].pixels, kMinWidth);
  const Box plot{kLeft + (width - sides[0].pixels) / 2, kTop, sides[0].pixels, sides[1].pixels};
  Picture picture = make_picture(kLeft + width + kRight, kTop + plot.height + kBottom, kCanvas);
  draw_axes(picture, plot, sides[0], sides[1]);
  const ColourScale scale = scale_of(marks);
  draw_marks(picture, marks, plot, sides, scale);
  const bool has_times = !beams.times_ns.empty();
  draw_colour_bar(picture, {kLeft, kTop + plot.height + 75, width, 0},
                  {has_times ? "firing time" : "ring", has_times ? "ms" : "", scale, mark_colour},
                  kLetters);
  AtomicFile file(path);
  write_png(picture, "directions of the beams", file);
  file.commit();
}

}  // namespace glidar
