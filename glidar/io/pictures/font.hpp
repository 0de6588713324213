// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the project: text in pictures.

#include <glidar/io/pictures/picture.hpp>

#include <span>
#include <string_view>

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

}  // namespace glidar
