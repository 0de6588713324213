// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/font.hpp>

#include <glidar/core/text.hpp>

#include <algorithm>
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
