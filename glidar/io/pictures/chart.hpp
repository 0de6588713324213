// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/pictures/colour_scale.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// The font of pictures: DejaVu Sans, with the Latin, Greek and Cyrillic letters and the symbols of
/// ASCII and Latin-1. Licence: glidar/io/pictures/font/LICENSE.
std::span<const unsigned char> font_bytes();

/// Width of a line of UTF-8 in pixels at this size (the em, in pixels). Characters that the font
/// lacks, and bytes that are not UTF-8, are drawn as boxes.
double text_width(std::string_view text, double size_px);

/// The position of a line of text.
struct TextPlace {
  enum class Align : std::uint8_t { left, centre, right };
  double x = 0.0;  ///< of the line's left end, centre or right end
  double y = 0.0;  ///< centre of the capital letters
  Align align = Align::left;
};

struct TextStyle {
  double size_px = 14.0;  ///< the em
  Colour colour = {};
};

/// Draws a line of UTF-8 with antialiasing, clipped to the picture. The same
/// pixels on every machine.
void draw_text(Picture& picture, const TextPlace& place, std::string_view text,
               const TextStyle& style);

/// Colours of everything but the data.
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
  bool in_degrees = false;  ///< labels are at round angles
};

/// A tick of an axis.
struct AxisLabel {
  double share = 0.0;  ///< position between the first edge (0) and the last (1)
  std::string text;
};

/// Ticks at round numbers along an axis of `pixels`, with `room_px` for each label.
std::vector<AxisLabel> axis_labels(const PlotAxis& axis, double pixels, double room_px);

/// Space for the parts of a plot, in pixels, by font size.
double across_axis_height(double size_px);
double upright_axis_width(double size_px);
double colour_bar_height(double size_px);
double legend_entry_height(double size_px);

/// Draws ticks, labels and the title below the plot.
void draw_across_axis(Picture& picture, const Box& plot, const PlotAxis& axis, double size_px);
/// Draws the vertical axis left of the plot, `labels` from the top; the title is above the plot.
void draw_upright_axis(Picture& picture, const Box& plot, const std::string& title,
                       const std::vector<AxisLabel>& labels, double size_px);
/// Draws lines through the plot at the labels.
void draw_grid(Picture& picture, const Box& plot, const std::vector<AxisLabel>& across,
               const std::vector<AxisLabel>& upright);

/// An arrowhead in the plot: a sensor at x, y (pixels) with the boresight dx, dy; a disc if these
/// are too short.
struct SensorMark {
  double x;
  double y;
  double dx;
  double dy;
};
void draw_sensor(Picture& picture, const Box& plot, const SensorMark& mark, double size_px);

/// A colour map: a function from a fraction of the scale to a colour.
using Ramp = Colour (*)(double);

/// A bar of all colours, with values below it and the title below these; ends
/// with clipped values are arrows.
struct ColourBar {
  std::string title;
  std::string unit;
  ColourScale scale;
  Ramp ramp = nullptr;
};
void draw_colour_bar(Picture& picture, const Box& place, const ColourBar& bar, double size_px);

/// A colour and its meaning.
struct LegendEntry {
  Colour colour;
  std::string text;
};

/// The first entries that fit a legend of this size, with long texts truncated; the
/// last one then states the number of omitted entries.
std::vector<LegendEntry> fitted_legend(const std::vector<LegendEntry>& entries, double width,
                                       double height, double size_px);
/// The height of a legend for this width.
double legend_height(const std::vector<LegendEntry>& entries, double width, double size_px);
/// Draws the entries in columns, row by row.
void draw_legend(Picture& picture, const Box& place, const std::vector<LegendEntry>& entries,
                 double size_px);

}  // namespace glidar
