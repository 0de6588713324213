// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/chart.hpp>

#include <glidar/core/text.hpp>
#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>

namespace glidar {
namespace {

constexpr double kCapitalHeight = 0.729;  // of the em, of DejaVu Sans: 1493 / 2048
constexpr char32_t kReplacement = 0xFFFD;

const stbtt_fontinfo& font() {
  static const stbtt_fontinfo kFont = [] {
    stbtt_fontinfo info{};
    [[maybe_unused]] const int is_read = stbtt_InitFont(&info, font_bytes().data(), 0);
    assert(is_read != 0);  // the embedded font is valid
    return info;
  }();
  return kFont;
}

/// Removes the first character from the text; kReplacement for an invalid byte.
char32_t take_character(std::string_view& text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t size = utf8_size(text);
  char32_t code = size == 0 ? kReplacement : size == 1 ? byte(0) : byte(0) & (0xFFU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) code = (code << 6U) | (byte(i) & 0x3FU);
  text.remove_prefix(std::max<std::size_t>(size, 1));
  return code;
}

/// Calls visit(glyph, pen) for each character, where `pen` is its start; returns the total
/// width.
template <class Visit>
double each_glyph(std::string_view text, double size_px, const Visit& visit) {
  const double scale = double{stbtt_ScaleForMappingEmToPixels(&font(), 1.0F)} * size_px;
  double pen = 0.0;
  while (!text.empty()) {
    const int glyph = stbtt_FindGlyphIndex(&font(), static_cast<int>(take_character(text)));
    visit(glyph, pen);
    int advance = 0;
    int bearing = 0;
    stbtt_GetGlyphHMetrics(&font(), glyph, &advance, &bearing);
    pen += scale * advance;
  }
  return pen;
}

/// Blends ink into a pixel by its coverage.
void mix(Colour& pixel, const Colour& ink, std::uint8_t cover) {
  const auto channel = [cover](std::uint8_t below, std::uint8_t above) {
    return static_cast<std::uint8_t>((below * (255 - cover) + above * cover + 127) / 255);
  };
  pixel = {channel(pixel.r, ink.r), channel(pixel.g, ink.g), channel(pixel.b, ink.b)};
}

/// One glyph with its origin at x, y of the picture.
void draw_glyph(Picture& picture, int glyph, double x, double y, const TextStyle& style) {
  const float scale = stbtt_ScaleForMappingEmToPixels(&font(), static_cast<float>(style.size_px));
  const double left = std::floor(x);
  const auto shift = static_cast<float>(x - left);
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;
  stbtt_GetGlyphBitmapBoxSubpixel(&font(), glyph, scale, scale, shift, 0.0F, &x0, &y0, &x1, &y1);
  const int width = x1 - x0;
  const int height = y1 - y0;
  if (width <= 0 || height <= 0) return;
  std::vector<std::uint8_t> cover(static_cast<std::size_t>(width) *
                                  static_cast<std::size_t>(height));
  stbtt_MakeGlyphBitmapSubpixel(&font(), cover.data(), width, height, width, scale, scale, shift,
                                0.0F, glyph);
  const auto first_col = static_cast<std::int64_t>(left) + x0;
  const auto first_row = static_cast<std::int64_t>(std::lround(y)) + y0;
  for (std::size_t i = 0; i < cover.size(); ++i) {
    const std::int64_t col = first_col + static_cast<std::int64_t>(i) % width;
    const std::int64_t row = first_row + static_cast<std::int64_t>(i) / width;
    if (col < 0 || row < 0 || col >= static_cast<std::int64_t>(picture.width) ||
        row >= static_cast<std::int64_t>(picture.height))
      continue;
    mix(picture
            .pixels[static_cast<std::size_t>(row) * picture.width + static_cast<std::size_t>(col)],
        style.colour, cover[i]);
  }
}

}  // namespace

double text_width(std::string_view text, double size_px) {
  return each_glyph(text, size_px, [](int /*glyph*/, double /*pen*/) {});
}

void draw_text(Picture& picture, const TextPlace& place, std::string_view text,
               const TextStyle& style) {
  const double share = place.align == TextPlace::Align::left     ? 0.0
                       : place.align == TextPlace::Align::centre ? 0.5
                                                                 : 1.0;
  const double left = place.x - share * text_width(text, style.size_px);
  const double baseline = place.y + 0.5 * kCapitalHeight * style.size_px;
  each_glyph(text, style.size_px, [&](int glyph, double pen) {
    draw_glyph(picture, glyph, left + pen, baseline, style);
  });
}

}  // namespace glidar

namespace glidar {
namespace {

using Align = TextPlace::Align;

/// The next round number: 1, 2 or 5 times a power of ten, or a round angle.
double round_step(double min_step, bool in_degrees) {
  constexpr std::array kParts = {10.0, 15.0, 30.0, 45.0, 60.0, 90.0};
  if (in_degrees && min_step > 5.0) {
    const auto* const part = std::lower_bound(kParts.begin(), kParts.end(), min_step);
    return part == kParts.end() ? 180.0 : *part;
  }
  const double power = power_of_ten(decimal_exponent(min_step));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= min_step) return factor * power;
  }
  return 10.0 * power;
}

std::size_t whole(double pixels) {
  return static_cast<std::size_t>(std::max(0.0, std::round(pixels)));
}

std::size_t line_px(double size_px) {
  return std::max<std::size_t>(1, whole(size_px / 16.0));
}

/// Labels between the ends of a bar, with enough distance to these.
std::vector<AxisLabel> bar_labels(const ColourBar& bar, double width, double size_px) {
  const auto [low, high] = scale_ends(bar.scale, bar.unit);
  if (!(bar.scale.span() > 0.0)) return {};
  std::vector<AxisLabel> labels =
      axis_labels({"", bar.scale.low, bar.scale.high}, width, 5.0 * size_px);
  std::erase_if(labels, [&, low = low, high = high](const AxisLabel& label) {
    const double half = 0.5 * text_width(label.text, size_px) + 0.6 * size_px;
    const double x = label.share * width;
    return x - half < text_width(low, size_px) || x + half > width - text_width(high, size_px);
  });
  return labels;
}

/// Cuts the corners of the bar's end, so that it becomes an arrow.
void cut_arrow(Picture& picture, const Box& bar, bool at_left) {
  const double half = 0.5 * static_cast<double>(bar.height);
  for (std::size_t row = 0; row < bar.height; ++row) {
    const double from_middle = std::abs(static_cast<double>(row) + 0.5 - half);
    const std::size_t cut = std::min(whole(from_middle), bar.width);
    fill(picture, {at_left ? bar.x : bar.x + bar.width - cut, bar.y + row, cut, 1}, kCanvas);
  }
}

/// The text, truncated with an ellipsis if necessary.
std::string cut_text(const std::string& text, double width, double size_px) {
  if (text_width(text, size_px) <= width) return text;
  std::string cut = text;
  while (!cut.empty() && text_width(cut + "...", size_px) > width) {
    cut.pop_back();
    // not within a multi-byte character
    while (!cut.empty() && (static_cast<unsigned char>(text[cut.size()]) & 0xC0U) == 0x80U)
      cut.pop_back();
  }
  return cut + "...";
}

struct LegendColumns {
  std::size_t count;
  double width;
};

LegendColumns legend_columns(const std::vector<LegendEntry>& entries, double width,
                             double size_px) {
  double widest = 0.0;
  for (const LegendEntry& entry : entries)
    widest = std::max(widest, text_width(entry.text, size_px));
  const double needed = widest + 3.0 * size_px;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::floor(width / needed)));
  return {std::clamp<std::size_t>(count, 1, std::max<std::size_t>(entries.size(), 1)), needed};
}

}  // namespace

std::vector<AxisLabel> axis_labels(const PlotAxis& axis, double pixels, double room_px) {
  const double low = std::min(axis.first, axis.last);
  const double high = std::max(axis.first, axis.last);
  if (!(high > low) || !(pixels > 0.0)) return {};
  const double step = round_step(room_px * (high - low) / pixels, axis.in_degrees);
  std::vector<AxisLabel> labels;
  const double slack = 1e-9 * (high - low);  // labels an end at a round number despite rounding
  const auto first = static_cast<std::int64_t>(std::ceil((low - slack) / step));
  const auto last = static_cast<std::int64_t>(std::floor((high + slack) / step));
  for (std::int64_t i = first; i <= last; ++i) {
    const double value = static_cast<double>(i) * step;
    std::string text = scale_number(value, step);
    if (axis.in_degrees) text += "\u00b0";
    labels.push_back({(value - axis.first) / (axis.last - axis.first), std::move(text)});
  }
  return labels;
}

double across_axis_height(double size_px) {
  return 3.2 * size_px;
}

double upright_axis_width(double size_px) {
  return 4.0 * size_px;
}

double colour_bar_height(double size_px) {
  return 3.9 * size_px;
}

double legend_entry_height(double size_px) {
  return 1.5 * size_px;
}

void draw_across_axis(Picture& picture, const Box& plot, const PlotAxis& axis, double size_px) {
  const auto left = static_cast<double>(plot.x);
  const auto width = static_cast<double>(plot.width);
  const auto bottom = static_cast<double>(plot.y + plot.height);
  const std::size_t line = line_px(size_px);
  for (const AxisLabel& label : axis_labels(axis, width, 5.0 * size_px)) {
    const double x = left + label.share * width;
    fill(picture,
         {whole(x - 0.5 * static_cast<double>(line)), plot.y + plot.height, line,
          whole(0.4 * size_px)},
         kInk);
    const double half =
        0.5 * text_width(label.text, size_px);  // labels stay within the height of the plot
    const double place = std::clamp(x, left + std::min(half - size_px, 0.0),
                                    left + width - std::min(half - size_px, 0.0));
    draw_text(picture, {place, bottom + 1.0 * size_px, Align::centre}, label.text, {size_px, kInk});
  }
  draw_text(picture, {left + 0.5 * width, bottom + 2.3 * size_px, Align::centre}, axis.title,
            {size_px, kInk});
}

void draw_upright_axis(Picture& picture, const Box& plot, const std::string& title,
                       const std::vector<AxisLabel>& labels, double size_px) {
  const auto left = static_cast<double>(plot.x);
  const std::size_t line = line_px(size_px);
  const std::size_t tick = whole(0.4 * size_px);
  for (const AxisLabel& label : labels) {
    const double y = static_cast<double>(plot.y) + label.share * static_cast<double>(plot.height);
    fill(picture,
         {plot.x - std::min(tick, plot.x), whole(y - 0.5 * static_cast<double>(line)), tick, line},
         kInk);
    draw_text(picture, {left - 0.7 * size_px, y, Align::right}, label.text, {size_px, kInk});
  }
  draw_text(picture,
            {std::max(0.0, left - upright_axis_width(size_px) + 0.4 * size_px),
             static_cast<double>(plot.y) - size_px, Align::left},
            title, {size_px, kInk});
}

void draw_grid(Picture& picture, const Box& plot, const std::vector<AxisLabel>& across,
               const std::vector<AxisLabel>& upright) {
  for (const AxisLabel& label : across) {
    const std::size_t x = plot.x + whole(label.share * static_cast<double>(plot.width - 1));
    fill(picture, {x, plot.y, 1, plot.height}, kGridLine);
  }
  for (const AxisLabel& label : upright) {
    const std::size_t y = plot.y + whole(label.share * static_cast<double>(plot.height - 1));
    fill(picture, {plot.x, y, plot.width, 1}, kGridLine);
  }
}

void draw_sensor(Picture& picture, const Box& plot, const SensorMark& mark, double size_px) {
  const double length = portable_hypot(mark.dx, mark.dy);
  const bool is_disc = length < 0.1;
  const double ahead_x = is_disc ? 0.0 : mark.dx / length;
  const double ahead_y = is_disc ? 0.0 : mark.dy / length;
  const auto is_covered = [&](double x, double y, double size) {
    const double along = x * ahead_x + y * ahead_y;
    const double across = std::abs(x * ahead_y - y * ahead_x);
    if (is_disc) return portable_hypot(x, y) <= 0.6 * size;
    return along >= -0.6 * size && across <= 0.5 * (size - along) * 0.75;
  };
  const auto reach = static_cast<std::int64_t>(2.0 * size_px);
  const auto left = static_cast<std::int64_t>(plot.x);
  const auto top = static_cast<std::int64_t>(plot.y);
  const auto mid_x = static_cast<std::int64_t>(std::floor(mark.x));
  const auto mid_y = static_cast<std::int64_t>(std::floor(mark.y));
  for (std::int64_t y = -reach; y <= reach; ++y) {
    for (std::int64_t x = -reach; x <= reach; ++x) {
      const std::int64_t col = mid_x + x;
      const std::int64_t row = mid_y + y;
      if (col < left || row < top || col >= left + static_cast<std::int64_t>(plot.width) ||
          row >= top + static_cast<std::int64_t>(plot.height))
        continue;
      const auto at_x = static_cast<double>(x);
      const auto at_y = static_cast<double>(y);
      if (!is_covered(at_x, at_y, size_px)) continue;
      const bool is_inner = is_covered(at_x, at_y, 0.72 * size_px);
      fill(picture, {static_cast<std::size_t>(col), static_cast<std::size_t>(row), 1, 1},
           is_inner ? kSensorInk : kCanvas);
    }
  }
}

void draw_colour_bar(Picture& picture, const Box& place, const ColourBar& bar, double size_px) {
  const auto left = static_cast<double>(place.x);
  const auto width = static_cast<double>(place.width);
  const auto top = static_cast<double>(place.y);
  const TextStyle style{size_px, kInk};
  const double title_y = top + 3.1 * size_px;
  if (!bar.scale.has_values) {
    draw_text(picture, {left + 0.5 * width, title_y, Align::centre}, bar.title + ": no returns",
              style);
    return;
  }
  const Box strip{place.x, place.y, place.width, whole(0.9 * size_px)};
  for (std::size_t i = 0; i < strip.width; ++i) {
    const double share =
        static_cast<double>(i) / std::max(1.0, static_cast<double>(strip.width) - 1.0);
    const double t = bar.scale.span() > 0.0 ? share : bar.scale.fraction(bar.scale.high);
    fill(picture, {strip.x + i, strip.y, 1, strip.height}, bar.ramp(t));
  }
  if (bar.scale.clips_low) cut_arrow(picture, strip, true);
  if (bar.scale.clips_high) cut_arrow(picture, strip, false);
  const double text_y = top + 1.7 * size_px;
  for (const AxisLabel& label : bar_labels(bar, width, size_px)) {
    const double x = left + label.share * width;
    fill(picture, {whole(x), strip.y + strip.height, line_px(size_px), whole(0.25 * size_px)},
         kInk);
    draw_text(picture, {x, text_y, Align::centre}, label.text, style);
  }
  const auto [low, high] = scale_ends(bar.scale, bar.unit);
  if (bar.scale.span() > 0.0) {
    draw_text(picture, {left, text_y, Align::left}, low, style);
    draw_text(picture, {left + width, text_y, Align::right}, high, style);
  } else {  // a single value has one colour
    draw_text(picture, {left + 0.5 * width, text_y, Align::centre}, high, style);
  }
  draw_text(picture, {left + 0.5 * width, title_y, Align::centre}, bar.title, style);
}

std::vector<LegendEntry> fitted_legend(const std::vector<LegendEntry>& entries, double width,
                                       double height, double size_px) {
  std::vector<LegendEntry> fitted = entries;
  for (LegendEntry& entry : fitted) {
    entry.text = cut_text(entry.text, 0.5 * width - 3.0 * size_px, size_px);
  }
  while (fitted.size() > 1 && legend_height(fitted, width, size_px) > height) {
    fitted.pop_back();
    fitted.back() = {kCanvas, fmt::format("and {} others", entries.size() - fitted.size() + 1)};
  }
  return fitted;
}

double legend_height(const std::vector<LegendEntry>& entries, double width, double size_px) {
  const std::size_t columns = legend_columns(entries, width, size_px).count;
  const std::size_t rows = (entries.size() + columns - 1) / columns;
  return static_cast<double>(rows) * legend_entry_height(size_px);
}

void draw_legend(Picture& picture, const Box& place, const std::vector<LegendEntry>& entries,
                 double size_px) {
  const LegendColumns columns = legend_columns(entries, static_cast<double>(place.width), size_px);
  const std::size_t patch = whole(0.8 * size_px);
  const double used = columns.width * static_cast<double>(columns.count);
  const double left =
      static_cast<double>(place.x) + std::max(0.0, 0.5 * (static_cast<double>(place.width) - used));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::size_t row = i / columns.count;
    const double x = left + columns.width * static_cast<double>(i % columns.count);
    const double y = static_cast<double>(place.y) +
                     legend_entry_height(size_px) * (0.5 + static_cast<double>(row));
    fill(picture, {whole(x), whole(y - 0.5 * static_cast<double>(patch)), patch, patch},
         entries[i].colour);
    draw_text(picture, {x + 1.3 * size_px, y, Align::left}, entries[i].text, {size_px, kInk});
  }
}

}  // namespace glidar
