// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/cloud_file.hpp>
#include <glidar/io/picture.hpp>
#include <glidar/io/png_image.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace glidar {
namespace {

constexpr Colour kCanvas = {17, 17, 20};
constexpr Colour kNoReturn = {34, 34, 40};
constexpr Colour kInk = {205, 205, 210};

using Ramp = Colour (*)(double);

/// One picture of the pair and its scale.
struct Panel {
  std::string title;
  std::string unit;
  Ramp ramp = nullptr;
  double low = 0.0;
  double high = 0.0;
  bool any = false;            ///< false: no beam has a return, low and high mean nothing
  std::vector<Colour> pixels;  ///< one per beam
};

/// All lengths in pixels.
struct Layout {
  std::size_t zoom;  ///< pixels per beam across, so that small images can be seen
  std::size_t tall;  ///< and upright: scanners have few rows and many columns
  std::size_t dot;   ///< of the letters
  std::size_t gap;
  std::size_t footer;  ///< height of the scale below a panel
  std::size_t cell_width;
  std::size_t cell_height;
  bool stacked;  ///< wide images stand one above the other
};

/// Near is bright.
Colour depth_ramp(double t) {
  return viridis(1.0 - t);
}

Colour grey_ramp(double t) {
  const auto level = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(t, 0.0, 1.0)));
  return {level, level, level};
}

void colour_pixels(Panel& panel, const std::vector<double>& depths_m, const auto& value_of) {
  panel.pixels.assign(depths_m.size(), kNoReturn);
  const double span = panel.high - panel.low;
  for (std::size_t i = 0; i < depths_m.size(); ++i) {
    if (std::isnan(depths_m[i])) continue;
    const double t = span > 0.0 ? (double{value_of(i)} - panel.low) / span : 0.0;
    panel.pixels[i] = panel.ramp(t);
  }
}

Panel distance_panel(std::string title, const std::vector<double>& depths_m) {
  Panel panel{std::move(title),
              " m",
              depth_ramp,
              std::numeric_limits<double>::infinity(),
              -std::numeric_limits<double>::infinity(),
              false,
              {}};
  for (const double depth_m : depths_m) {
    if (std::isnan(depth_m)) continue;
    panel.any = true;
    panel.low = std::min(panel.low, depth_m);
    panel.high = std::max(panel.high, depth_m);
  }
  colour_pixels(panel, depths_m, [&](std::size_t i) { return depths_m[i]; });
  return panel;
}

Panel intensity_panel(const std::vector<double>& depths_m, const std::vector<float>& intensity) {
  Panel panel{"intensity", "", grey_ramp, 0.0, 0.0, false, {}};
  for (std::size_t i = 0; i < depths_m.size(); ++i) {
    if (std::isnan(depths_m[i])) continue;
    panel.any = true;
    panel.high = std::max(panel.high, double{intensity[i]});
  }
  colour_pixels(panel, depths_m, [&](std::size_t i) { return intensity[i]; });
  return panel;
}

/// As many digits as tell the ends of the scale apart to a percent.
std::string number_text(double value, double span) {
  if (value == 0.0) return "0";
  const double needed = span > 0.0 ? 2.0 - std::floor(std::log10(span)) : 3.0;
  const int decimals = static_cast<int>(std::clamp(needed, 0.0, 9.0));
  const std::string plain = fmt::format("{:.{}f}", value, decimals);
  constexpr std::size_t kLongest = 12;
  return plain.size() <= kLongest ? plain : fmt::format("{:.4g}", value);
}

/// What stands left and right of the colour bar.
std::array<std::string, 2> scale_texts(const Panel& panel) {
  if (!panel.any) return {panel.title + "  no hits", ""};
  const double span = panel.high - panel.low;
  return {panel.title + "  " + number_text(panel.low, span),
          number_text(panel.high, span) + panel.unit};
}

Layout make_layout(const PointCloud& cloud, const std::array<Panel, 2>& panels) {
  constexpr std::size_t kUsual = 512;
  const std::size_t longer = std::max<std::size_t>({cloud.rows, cloud.cols, 1});
  Layout layout{};
  layout.zoom = std::max<std::size_t>(1, kUsual / longer);
  constexpr std::size_t kLeastShape = 8;  // a picture is at most so many times as wide as high
  constexpr std::size_t kTallest = 64;
  const std::size_t width = cloud.cols * layout.zoom;
  layout.tall = std::clamp<std::size_t>(width / (kLeastShape * std::max(1U, cloud.rows)),
                                        layout.zoom, std::max(layout.zoom, kTallest));
  layout.dot = std::clamp<std::size_t>((width + 768) / 512, 1, 6);
  layout.gap = 8 * layout.dot;
  layout.footer = (kTextHeightDots + 4) * layout.dot;
  layout.cell_width = width;
  for (const Panel& panel : panels) {
    const auto [left, right] = scale_texts(panel);
    const std::size_t bar = 36 * layout.dot;
    layout.cell_width = std::max(
        layout.cell_width, text_width(left, layout.dot) + bar + text_width(right, layout.dot));
  }
  layout.cell_height = cloud.rows * layout.tall + layout.footer;
  layout.stacked = cloud.cols > 2 * cloud.rows;
  return layout;
}

void draw_bar(Picture& picture, const Box& box, Ramp ramp) {
  const double last = std::max(1.0, static_cast<double>(box.width) - 1.0);
  for (std::size_t i = 0; i < box.width; ++i)
    fill(picture, {box.x + i, box.y, 1, box.height}, ramp(static_cast<double>(i) / last));
}

void draw_scale(Picture& picture, const Panel& panel, const Layout& layout, Box place) {
  const std::size_t dot = layout.dot;
  const auto [left, right] = scale_texts(panel);
  draw_text(picture, {place.x, place.y, dot, dot}, left, kInk);
  if (!panel.any) return;
  const std::size_t right_width = text_width(right, dot);
  draw_text(picture, {place.x + place.width - right_width, place.y, dot, dot}, right, kInk);
  const std::size_t space = 6 * dot;
  const std::size_t start = text_width(left, dot) + space;
  draw_bar(
      picture,
      {place.x + start, place.y, place.width - start - right_width - space, kTextHeightDots * dot},
      panel.ramp);
}

void draw_panel(Picture& picture, const Panel& panel, const Layout& layout, const Box& place) {
  const std::size_t zoom = layout.zoom;
  const std::size_t cols = place.width / zoom;
  const std::size_t left = place.x + (layout.cell_width - place.width) / 2;
  for (std::size_t i = 0; i < panel.pixels.size(); ++i) {
    fill(picture, {left + i % cols * zoom, place.y + i / cols * layout.tall, zoom, layout.tall},
         panel.pixels[i]);
  }
  draw_scale(picture, panel, layout,
             {place.x, place.y + place.height + 4 * layout.dot, layout.cell_width, layout.footer});
}

}  // namespace

void write_preview(const CloudFile& job, AtomicFile& file) {
  const PointCloud& cloud = job.cloud;
  // the depth of what lies behind a scanner would be negative
  const bool camera = looks_along_z(job.context.beams);
  const std::string title = camera ? "depth" : "range";
  std::vector<double> depths_m = std::get<std::vector<double>>(find_column(cloud, "depth")->values);
  if (!camera) {
    depths_m = job.frame.range_m;
    for (double& range_m : depths_m) range_m += job.context.beams.range_offset_m;
  }
  const auto& intensity = std::get<std::vector<float>>(find_column(cloud, "intensity")->values);
  const std::array<Panel, 2> panels = {distance_panel(title, depths_m),
                                       intensity_panel(depths_m, intensity)};
  const Layout layout = make_layout(cloud, panels);
  const std::size_t step_x = layout.stacked ? 0 : layout.cell_width + layout.gap;
  const std::size_t step_y = layout.stacked ? layout.cell_height + layout.gap : 0;
  Picture picture = make_picture(2 * layout.gap + layout.cell_width + step_x,
                                 2 * layout.gap + layout.cell_height + step_y, kCanvas);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    draw_panel(picture, panels[i], layout,
               {layout.gap + i * step_x, layout.gap + i * step_y, cloud.cols * layout.zoom,
                cloud.rows * layout.tall});
  }
  write_png({PngKind::rgb8, static_cast<std::uint32_t>(picture.width),
             static_cast<std::uint32_t>(picture.height), std::as_bytes(std::span(picture.pixels)),
             title + " beside intensity"},
            file);
}

}  // namespace glidar
