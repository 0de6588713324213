// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/atomic_file.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
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

enum class PngKind : std::uint8_t { grey8, grey16, rgb8, rgb16, rgba8 };

/// Pixels row by row from the top, without padding; 16-bit numbers in memory order.
struct PngImage {
  PngKind kind = PngKind::rgb8;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::span<const std::byte> pixels;
  std::string description;  ///< text stored in the file; empty: none
};

/// Writes a PNG. Throws Error when it cannot be written.
void write_png(const PngImage& image, AtomicFile& file);
void write_png(const Picture& picture, const std::string& description, AtomicFile& file);

/// The bytes of a PNG file. Throws Error when the system has no memory for them.
std::vector<std::byte> encode_png(const PngImage& image);

}  // namespace glidar
