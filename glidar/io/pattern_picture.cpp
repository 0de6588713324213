// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pattern_picture.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/io/picture.hpp>
#include <glidar/io/png_image.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

constexpr Colour kCanvas = {17, 17, 20};
constexpr Colour kPlot = {34, 34, 40};
constexpr Colour kGrid = {60, 60, 68};
constexpr Colour kInk = {205, 205, 210};
constexpr std::size_t kDot = 2;  // of the letters
constexpr std::size_t kWide = 1080;
constexpr std::size_t kTall = 720;
constexpr std::size_t kLeft = 140;  // room for the labels
constexpr std::size_t kTop = 60;
constexpr std::size_t kRight = 40;
constexpr std::size_t kBottom = 110;
constexpr double kRadian_deg = 180.0 / std::numbers::pi;

/// Where a beam looks, in degrees to the left and up, and its place on the colour scale.
struct Mark {
  double left_deg;
  double up_deg;
  double value;
};

struct Axis {
  double low_deg = 0.0;
  double high_deg = 0.0;
  std::size_t pixels = 0;

  [[nodiscard]] double place(double deg) const {
    return (deg - low_deg) / (high_deg - low_deg) * static_cast<double>(pixels - 1);
  }
};

/// Every so many rows and columns of an image, so that dots stay apart.
std::size_t stride_of(const Beams& beams) {
  constexpr std::size_t kMostAcross = 64;
  const bool image = beams.times_ns.empty() && beams.rows > 1;
  return image ? std::max<std::size_t>(1, std::max(beams.rows, beams.cols) / kMostAcross) : 1;
}

/// The darkest colours would be lost before the ground.
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

std::vector<Mark> marks_of(const Beams& beams) {
  const SensorAxes axes = axes_of(beams);
  std::vector<Mark> marks;
  const std::size_t step = stride_of(beams);
  for (std::size_t row = 0; row < beams.rows; row += step) {
    for (std::size_t col = 0; col < beams.cols; col += step) {
      const std::size_t i = row * beams.cols + col;
      const Eigen::Vector3d& d = beams.directions[i];
      if (std::isnan(d.x())) continue;
      marks.push_back({kRadian_deg * azimuth_rad(axes, d), kRadian_deg * elevation_rad(axes, d),
                       value_of(beams, i)});
    }
  }
  if (marks.empty()) throw Error({"picture of the beams", "there are none", "", ""});
  return marks;
}

/// The range of one angle with a margin; a single line gets one of its own.
Axis axis_of(const std::vector<Mark>& marks, double Mark::*angle) {
  const auto [low, high] =
      std::minmax_element(marks.begin(), marks.end(),
                          [angle](const Mark& a, const Mark& b) { return a.*angle < b.*angle; });
  const double margin_deg = std::max(0.04 * ((*high).*angle - (*low).*angle), 0.5);
  return {(*low).*angle - margin_deg, (*high).*angle + margin_deg, 0};
}

/// Degrees are as wide as high unless one side is much longer.
void size_axes(Axis& across, Axis& upright) {
  constexpr double kMostStretch = 4.0;
  const double width_deg = across.high_deg - across.low_deg;
  const double height_deg = upright.high_deg - upright.low_deg;
  const double scale = std::min(kWide / width_deg, kTall / height_deg);
  const double stretch = std::clamp(0.3 * kWide / (scale * height_deg), 1.0, kMostStretch);
  across.pixels = static_cast<std::size_t>(std::max(scale * width_deg, 200.0));
  upright.pixels = static_cast<std::size_t>(std::max(scale * stretch * height_deg, 60.0));
}

/// A round step that gives a handful of labels.
double step_of(const Axis& axis, double label_pixels) {
  const double least_deg =
      label_pixels * (axis.high_deg - axis.low_deg) / static_cast<double>(axis.pixels);
  for (const double step : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 60.0}) {
    if (step >= least_deg) return step;
  }
  return 90.0;
}

/// Calls visit(angle, place in pixels) for each label.
template <class Visit>
void each_label(const Axis& axis, double label_pixels, const Visit& visit) {
  const double step = step_of(axis, label_pixels);
  const auto first = static_cast<int>(std::ceil(axis.low_deg / step));
  const auto last = static_cast<int>(std::floor(axis.high_deg / step));
  for (int i = first; i <= last; ++i) {
    visit(i * step, static_cast<std::size_t>(std::lround(axis.place(i * step))));
  }
}

void draw_axes(Picture& picture, const Axis& across, const Axis& upright) {
  fill(picture, {kLeft, kTop, across.pixels, upright.pixels}, kPlot);
  const std::size_t bottom = kTop + upright.pixels;
  each_label(across, 90.0, [&](double deg, std::size_t place) {
    const std::size_t x = kLeft + across.pixels - 1 - place;  // left is left
    fill(picture, {x, kTop, 1, upright.pixels}, kGrid);
    const std::string text = fmt::format("{:g}", deg);
    draw_text(picture, {x - text_width(text, kDot) / 2, bottom + 4 * kDot, kDot, kDot}, text, kInk);
  });
  each_label(upright, 30.0, [&](double deg, std::size_t place) {
    const std::size_t y = bottom - 1 - place;
    fill(picture, {kLeft, y, across.pixels, 1}, kGrid);
    const std::string text = fmt::format("{:g}", deg);
    draw_text(
        picture,
        {kLeft - text_width(text, kDot) - 4 * kDot, y - kTextHeightDots * kDot / 2, kDot, kDot},
        text, kInk);
  });
  draw_text(picture, {4 * kDot, kTop - 16 * kDot, kDot, kDot}, "elevation deg", kInk);
  const std::string caption = "azimuth deg";
  draw_text(picture,
            {kLeft + across.pixels - text_width(caption, kDot), bottom + 16 * kDot, kDot, kDot},
            caption, kInk);
}

/// Low and high of the colours.
std::array<double, 2> span_of(const std::vector<Mark>& marks) {
  const auto [low, high] = std::minmax_element(
      marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.value < b.value; });
  return {low->value, high->value};
}

void draw_marks(Picture& picture, const std::vector<Mark>& marks, const Axis& across,
                const Axis& upright) {
  const auto [low, high] = span_of(marks);
  const std::size_t size = marks.size() < 20'000 ? 2 : 1;
  for (const Mark& mark : marks) {
    const auto right = static_cast<std::size_t>(std::lround(across.place(mark.left_deg)));
    const auto up = static_cast<std::size_t>(std::lround(upright.place(mark.up_deg)));
    fill(picture, {kLeft + across.pixels - 1 - right, kTop + upright.pixels - 1 - up, size, size},
         mark_colour(high > low ? (mark.value - low) / (high - low) : 1.0));
  }
}

void draw_legend(Picture& picture, const std::vector<Mark>& marks, bool times, std::size_t y) {
  const auto [low, high] = span_of(marks);
  const std::string left = fmt::format("{}  {:.4g}", times ? "time" : "ring", low);
  const std::string right = fmt::format("{:.4g}{}", high, times ? " ms" : "");
  constexpr std::size_t kBar = 200;
  const std::size_t start = kLeft + text_width(left, kDot) + 6 * kDot;
  draw_text(picture, {kLeft, y, kDot, kDot}, left, kInk);
  for (std::size_t i = 0; i < kBar; ++i) {
    fill(picture, {start + i, y, 1, kTextHeightDots * kDot},
         mark_colour(static_cast<double>(i) / (kBar - 1.0)));
  }
  draw_text(picture, {start + kBar + 6 * kDot, y, kDot, kDot}, right, kInk);
}

}  // namespace

void write_pattern_picture(const Beams& beams, const std::filesystem::path& path) {
  const std::vector<Mark> marks = marks_of(beams);
  Axis across = axis_of(marks, &Mark::left_deg);
  Axis upright = axis_of(marks, &Mark::up_deg);
  size_axes(across, upright);
  constexpr std::size_t kLegend = 460;  // the least width that holds it
  Picture picture = make_picture(kLeft + std::max(across.pixels, kLegend) + kRight,
                                 kTop + upright.pixels + kBottom, kCanvas);
  draw_axes(picture, across, upright);
  draw_marks(picture, marks, across, upright);
  draw_legend(picture, marks, !beams.times_ns.empty(), kTop + upright.pixels + 36 * kDot);
  AtomicFile file(path);
  write_png({PngKind::rgb8, static_cast<std::uint32_t>(picture.width),
             static_cast<std::uint32_t>(picture.height), std::as_bytes(std::span(picture.pixels)),
             "directions of the beams"},
            file);
  file.commit();
}

}  // namespace glidar
