// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the project.

#include <glidar/io/pictures/picture.hpp>

#include <span>
#include <string_view>

namespace glidar {

/// The font of pictures: DejaVu Sans, of which Latin, Greek and Cyrillic letters and the signs of
/// ASCII and Latin-1 are in the library. Licence: glidar/io/pictures/font/LICENSE.
std::span<const unsigned char> font_bytes();

/// Width of a line of UTF-8 in pixels at this size (the em, in pixels). Characters that the font
/// lacks, and bytes that are no UTF-8, have the width of the box that is drawn for them.
double text_width(std::string_view text, double size_px);

/// Where a line of text is.
struct TextPlace {
  enum class Align : std::uint8_t { left, centre, right };
  double x = 0.0;  ///< of the line's left end, middle or right end
  double y = 0.0;  ///< the middle of its capital letters
  Align align = Align::left;
};

struct TextStyle {
  double size_px = 14.0;  ///< the em
  Colour colour = {};
};

/// Draws a line of UTF-8 with smooth edges; pixels outside the picture are left out. The same
/// pixels on every machine.
void draw_text(Picture& picture, const TextPlace& place, std::string_view text,
               const TextStyle& style);

}  // namespace glidar
