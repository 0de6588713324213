// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glidar {

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
