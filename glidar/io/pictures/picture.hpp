// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar {

struct Colour {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;

  bool operator==(const Colour&) const = default;
};
static_assert(sizeof(Colour) == 3, "written to files as in memory");

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

/// Fills the part of the box that is inside the picture.
void fill(Picture& picture, const Box& box, Colour colour);

/// The colour map viridis (Nathaniel Smith and Stefan van der Walt, CC0), from dark (0) to bright
/// (1), interpolated between 33 of its entries.
Colour viridis(double t);

/// From black (0) to white (1).
Colour grey(double t);

/// From a grey that is visible on the dark background of a plot (0) to white (1).
Colour light_grey(double t);

/// The colour of a hue from 0 to 1: red, yellow, green, cyan, blue, magenta, red.
Colour hue(double turn);

/// Colours of categories, with large differences between consecutive ones: twelve fixed ones that
/// are visible on a dark background, then hues at golden-ratio steps.
Colour category_colour(std::uint32_t number);

}  // namespace glidar
