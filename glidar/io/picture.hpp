// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace glidar {

struct Colour {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
};
static_assert(sizeof(Colour) == 3, "written to files as it is");

/// Pixels row by row from the top.
struct Picture {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<Colour> pixels;
};

struct Box {
  std::size_t x = 0;
  std::size_t y = 0;
  std::size_t width = 0;
  std::size_t height = 0;
};

Picture make_picture(std::size_t width, std::size_t height, Colour background);

/// The box must lie inside the picture.
void fill(Picture& picture, const Box& box, Colour colour);

/// Letters are 5 x 7 dots with one dot between; `dot` is the size of a dot in pixels.
inline constexpr std::size_t kTextHeightDots = 7;
std::size_t text_width(std::string_view text, std::size_t dot);

/// Draws digits, ". - +" and the few letters that scales need (others are left blank) with the
/// upper left corner at x, y. The text must lie inside the picture.
void draw_text(Picture& picture, const Box& corner_and_dot, std::string_view text, Colour colour);

/// The colour map viridis (Nathaniel Smith and Stefan van der Walt, CC0), from dark (0) to bright
/// (1), interpolated between 33 of its entries.
Colour viridis(double t);

}  // namespace glidar
