// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the project.

#include <glidar/io/pictures/colour_scale.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <string>
#include <vector>

namespace glidar {

/// Colours of what is around the data.
inline constexpr Colour kCanvas = {17, 17, 20};
inline constexpr Colour kPlotGround = {26, 26, 31};
inline constexpr Colour kNoReturn = {44, 44, 52};
inline constexpr Colour kGridLine = {58, 58, 66};
inline constexpr Colour kSensorInk = {255, 255, 255};
inline constexpr Colour kInk = {222, 222, 228};

/// One side of a plot: the numbers at its first and at its last edge.
struct PlotAxis {
  std::string title;  ///< with its unit
  double first = 0.0;
  double last = 1.0;
  bool in_degrees = false;  ///< labels are parts of a turn
};

/// A mark of an axis.
struct AxisLabel {
  double share = 0.0;  ///< of the way from the first edge to the last
  std::string text;
};

/// Round numbers along an axis of so many pixels, with room for labels of a size.
std::vector<AxisLabel> axis_labels(const PlotAxis& axis, double pixels, double room_px);

/// Space that the parts of a plot need, in pixels, by the size of the letters.
double across_axis_height(double size_px);
double upright_axis_width(double size_px);
double colour_bar_height(double size_px);
double legend_entry_height(double size_px);

/// Marks, numbers and the title below the plot.
void draw_across_axis(Picture& picture, const Box& plot, const PlotAxis& axis, double size_px);
/// Likewise at its left, where `labels` are counted from the top; the title is above the plot.
void draw_upright_axis(Picture& picture, const Box& plot, const std::string& title,
                       const std::vector<AxisLabel>& labels, double size_px);
/// Lines through the plot at the labels.
void draw_grid(Picture& picture, const Box& plot, const std::vector<AxisLabel>& across,
               const std::vector<AxisLabel>& upright);

/// An arrowhead in the plot: a sensor at x, y (pixels) that looks along dx, dy; a disc where these
/// are too short to tell.
struct SensorMark {
  double x;
  double y;
  double dx;
  double dy;
};
void draw_sensor(Picture& picture, const Box& plot, const SensorMark& mark, double size_px);

/// How a fraction of a scale becomes a colour.
using Ramp = Colour (*)(double);

/// A bar of all colours with the numbers that they mean below it and its title below these; ends
/// that stand for values beyond are arrows.
struct ColourBar {
  std::string title;
  std::string unit;
  ColourScale scale;
  Ramp ramp = nullptr;
};
void draw_colour_bar(Picture& picture, const Box& place, const ColourBar& bar, double size_px);

/// A colour and what it means.
struct LegendEntry {
  Colour colour;
  std::string text;
};

/// As many entries, from the first, as a legend of this size has room for, long texts cut off; the
/// last one then says how many others there are.
std::vector<LegendEntry> fitted_legend(const std::vector<LegendEntry>& entries, double width,
                                       double height, double size_px);
/// The height that a legend needs in this width.
double legend_height(const std::vector<LegendEntry>& entries, double width, double size_px);
/// Entries in columns, row by row.
void draw_legend(Picture& picture, const Box& place, const std::vector<LegendEntry>& entries,
                 double size_px);

}  // namespace glidar
