// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/image_files.hpp>

#include <glidar/io/pictures/png_image.hpp>

#include <cmath>
#include <vector>

namespace glidar::app {
namespace {

constexpr double kMaxPngNumber = 65535.0;

}  // namespace

void write_multiples_png(std::span<const float> values, double unit, const std::string& description,
                         ImageSize size, AtomicFile& file) {
  std::vector<std::uint16_t> pixels;
  pixels.reserve(values.size());
  for (const float value : values) {
    const double number = std::round(static_cast<double>(value) / unit);
    const bool fits = number > 0.0 && number <= kMaxPngNumber;
    pixels.push_back(fits ? static_cast<std::uint16_t>(number) : std::uint16_t{0});
  }
  write_png(
      {PngKind::grey16, size.width, size.height, std::as_bytes(std::span(pixels)), description},
      file);
}

void write_status_png(std::span<const std::uint8_t> numbers, std::span<const Colour> colours,
                      ImageSize size, AtomicFile& file) {
  Picture picture = make_picture(size.width, size.height, Colour{});
  for (std::size_t i = 0; i < numbers.size(); ++i) picture.pixels[i] = colours[numbers[i]];
  write_png(picture, "status of each pixel", file);
}

}  // namespace glidar::app
