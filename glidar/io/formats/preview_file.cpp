// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/format.hpp>

#include <glidar/io/config/camera_info.hpp>
#include <glidar/io/pictures/beam_picture.hpp>
#include <glidar/io/pictures/chart.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace glidar {
namespace {

/// A panel: one value per beam, in colours.
struct Panel {
  ColourBar bar;
  const std::vector<double>& values;
  const BeamPicture& beams;
};

/// All lengths in pixels.
struct PreviewLayout {
  std::size_t zoom;  ///< horizontal pixels per beam, so that small images are visible
  std::size_t tall;  ///< vertical pixels per beam, because scanners have few rows and many columns
  double letters;
  std::size_t gap;
  Box plot;  ///< the plot's box in its cell
  std::size_t cell_width;
  std::size_t cell_height;
  std::size_t cells_across;
};

/// Near is bright.
Colour near_ramp(double t) {
  return viridis(1.0 - t);
}

bool has_axes(const BeamPicture& beams) {
  return beams.kind != BeamPicture::Kind::image;
}

PreviewLayout make_layout(const BeamPicture& beams) {
  constexpr std::size_t kDefault = 512;
  constexpr std::size_t kMinShape = 8;  // maximum ratio of width to height
  constexpr std::size_t kTallest = 64;
  const std::size_t cols = std::max(1U, beams.cols);
  const std::size_t rows = std::max(1U, beams.rows);
  PreviewLayout layout{};
  layout.zoom = std::max<std::size_t>(1, kDefault / std::max(cols, rows));
  const std::size_t width = cols * layout.zoom;
  constexpr std::size_t kMaxPreviewPixels = std::size_t{1} << 26U;  // maximum after stretching rows
  const std::size_t tallest = std::min(kTallest, kMaxPreviewPixels / (width * rows));
  layout.tall = std::clamp<std::size_t>(width / (kMinShape * rows), layout.zoom,
                                        std::max(layout.zoom, tallest));
  const std::size_t height = rows * layout.tall;
  constexpr double kMaxLetters = 48.0;
  layout.letters =
      std::min(kMaxLetters, 12.0 + static_cast<double>(std::max(width, height)) / 128.0);
  layout.gap = static_cast<std::size_t>(layout.letters);
  const auto pixels = [](double length) { return static_cast<std::size_t>(std::ceil(length)); };
  const std::size_t left = has_axes(beams) ? pixels(upright_axis_width(layout.letters)) : 0;
  const std::size_t top = has_axes(beams) ? pixels(1.8 * layout.letters) : 0;
  const std::size_t axis = has_axes(beams) ? pixels(across_axis_height(layout.letters)) : 0;
  const std::size_t bar = pixels(colour_bar_height(layout.letters)) + layout.gap;
  const std::size_t room = std::max(width, pixels(18.0 * layout.letters));  // for the bar
  layout.plot = {left + (room - width) / 2, top, width, height};
  layout.cell_width = left + room + left / 2;
  layout.cell_height = top + height + axis + bar;
  layout.cells_across = width > 2 * height ? 1 : 2;
  return layout;
}

/// Rows of a grid have their own elevations; those of other pictures are evenly spaced.
std::vector<AxisLabel> upright_labels(const BeamPicture& beams, const Box& plot, double letters) {
  const auto height = static_cast<double>(plot.height);
  const double room = 2.2 * letters;
  const bool in_degrees = beams.kind != BeamPicture::Kind::top;
  if (beams.kind != BeamPicture::Kind::grid)
    return axis_labels({"", beams.top, beams.bottom, in_degrees}, height, room);
  const std::size_t rows = beams.row_elevations_deg.size();
  const auto fit = static_cast<std::size_t>(std::max(1.0, height / room));
  const std::size_t steps = std::min<std::size_t>({fit, rows - 1, 6});
  std::vector<AxisLabel> labels;
  for (std::size_t i = 0; i <= steps; ++i) {
    const std::size_t row = i * (rows - 1) / std::max<std::size_t>(steps, 1);
    labels.push_back({(static_cast<double>(row) + 0.5) / static_cast<double>(rows),
                      scale_number(beams.row_elevations_deg[row], 10.0) + "\u00b0"});
  }
  return labels;
}

void draw_axes(Picture& picture, const Panel& panel, const Box& plot, double letters) {
  const BeamPicture& beams = panel.beams;
  const bool is_top = beams.kind == BeamPicture::Kind::top;
  draw_across_axis(picture, plot, {is_top ? "x, m" : "azimuth", beams.left, beams.right, !is_top},
                   letters);
  draw_upright_axis(picture, plot, is_top ? "y, m" : "elevation",
                    upright_labels(beams, plot, letters), letters);
  if (!is_top) return;
  const double x = -beams.left / (beams.right - beams.left) * static_cast<double>(plot.width);
  const double y = beams.top / (beams.top - beams.bottom) * static_cast<double>(plot.height);
  draw_sensor(picture, plot,
              {static_cast<double>(plot.x) + x, static_cast<double>(plot.y) + y, 1.0, 0.0},
              letters);
}

Colour pixel_colour(const Panel& panel, std::uint32_t beam) {
  const double value = panel.values[beam];
  return std::isfinite(value) ? panel.bar.ramp(panel.bar.scale.fraction(value)) : kNoReturn;
}

void draw_panel(Picture& picture, const Panel& panel, const PreviewLayout& layout,
                const Box& cell) {
  const Box plot{cell.x + layout.plot.x, cell.y + layout.plot.y, layout.plot.width,
                 layout.plot.height};
  fill(picture, plot, kPlotGround);
  const BeamPicture& beams = panel.beams;
  for (std::size_t i = 0; i < std::size_t{beams.rows} * beams.cols; ++i) {
    const std::uint32_t beam = beams.beam_at(i);
    if (beam == BeamPicture::kNoBeam) continue;
    fill(picture,
         {plot.x + i % beams.cols * layout.zoom, plot.y + i / beams.cols * layout.tall, layout.zoom,
          layout.tall},
         pixel_colour(panel, beam));
  }
  if (has_axes(beams)) draw_axes(picture, panel, plot, layout.letters);
  const double bar_y =
      static_cast<double>(cell.y + cell.height) - colour_bar_height(layout.letters);
  const double margin = has_axes(beams) ? upright_axis_width(layout.letters) : 0.0;
  const auto left = static_cast<std::size_t>(margin);
  draw_colour_bar(picture,
                  {cell.x + left, static_cast<std::size_t>(bar_y), cell.width - left - left / 2, 0},
                  panel.bar, layout.letters);
}

/// The data of the panels.
struct Measured {
  std::string distance_title;         ///< "depth" or "range"
  std::vector<double> distance_m;     ///<
  std::vector<double> intensity;      ///< one per beam, NaN without a return
  std::vector<BeamPicture> pictures;  ///< one per return
};

Measured measured_of(const CloudFile& job) {
  const PointCloud& cloud = job.cloud;
  const Beams& beams = job.context.beams;
  Measured measured;
  // points behind a scanner would have a negative depth
  const bool is_camera = looks_along_z(beams);
  const bool has_depths = is_camera && !images_have_range(job.context.sensor, beams);
  measured.distance_title = has_depths ? "depth" : "range";
  const std::vector<double>& range_m = job.frame.range_m;
  if (has_depths) {
    measured.distance_m = std::get<std::vector<double>>(find_column(cloud, "depth")->values);
  } else {
    measured.distance_m = range_m;
    for (double& distance_m : measured.distance_m) distance_m += beams.range_offset_m;
  }
  const auto& intensity = std::get<std::vector<float>>(find_column(cloud, "intensity")->values);
  for (std::size_t i = 0; i < intensity.size(); ++i) {
    measured.intensity.push_back(std::isnan(measured.distance_m[i])
                                     ? std::numeric_limits<double>::quiet_NaN()
                                     : double{intensity[i]});
  }
  for (std::uint32_t k = 0; k < beams.returns; ++k) {
    measured.pictures.push_back(is_camera
                                    ? make_image_picture(cloud.rows / beams.returns, cloud.cols, k)
                                    : make_beam_picture(beams, range_m, k));
  }
  return measured;
}

/// Distance and intensity of every return; all returns have the same scale.
std::vector<Panel> panels_of(const Measured& measured) {
  const ColourScale distance = make_colour_scale(measured.distance_m);
  const ColourScale intensity = make_colour_scale(measured.intensity, ColourScale::Start::zero);
  std::vector<Panel> panels;
  for (std::size_t k = 0; k < measured.pictures.size(); ++k) {
    const BeamPicture::Kind kind = measured.pictures[k].kind;
    const bool is_plot = kind == BeamPicture::Kind::angles || kind == BeamPicture::Kind::top;
    const std::string number =
        measured.pictures.size() > 1 ? fmt::format(" of return {}", k + 1) : "";
    panels.push_back({{measured.distance_title + number, "m", distance, near_ramp},
                      measured.distance_m,
                      measured.pictures[k]});
    panels.push_back({{"intensity" + number, "", intensity, is_plot ? light_grey : grey},
                      measured.intensity,
                      measured.pictures[k]});
  }
  return panels;
}

/// Writes a preview: coloured depth and grey intensity, each with its colour scale.
void write_preview(const CloudFile& job, AtomicFile& file) {
  const Measured measured = measured_of(job);
  const std::vector<Panel> panels = panels_of(measured);
  PreviewLayout layout = make_layout(measured.pictures.front());
  for (const BeamPicture& beams :
       measured.pictures) {  // top views of several returns differ in size
    const PreviewLayout other = make_layout(beams);
    layout.cell_width = std::max(layout.cell_width, other.cell_width);
    layout.cell_height = std::max(layout.cell_height, other.cell_height);
  }
  const std::size_t down = panels.size() / layout.cells_across;
  Picture picture =
      make_picture(layout.cells_across * (layout.cell_width + layout.gap) + layout.gap,
                   down * (layout.cell_height + layout.gap) + layout.gap, kCanvas);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    PreviewLayout own = make_layout(panels[i].beams);
    const Box cell{layout.gap + i % layout.cells_across * (layout.cell_width + layout.gap),
                   layout.gap + i / layout.cells_across * (layout.cell_height + layout.gap),
                   own.cell_width, own.cell_height};
    draw_panel(picture, panels[i], own, cell);
  }
  write_png(picture, measured.distance_title + " and intensity", file);
}

}  // namespace

Format preview_format() {
  return {.info = {.suffix = ".png",
                   .description = "preview picture",
                   .columns = {"depth", "intensity"}},
          .content = Content::per_beam,
          .write = write_preview};
}

}  // namespace glidar
