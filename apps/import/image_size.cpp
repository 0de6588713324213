// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/image_size.hpp>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <limits>
#include <string_view>
#include <system_error>

namespace glidar::import {
namespace {

std::uint64_t big_endian(std::string_view bytes) {
  std::uint64_t number = 0;
  for (const char byte : bytes) number = number << 8U | static_cast<std::uint8_t>(byte);
  return number;
}

/// ISO/IEC 15948, 5.2 and 11.2.2: width and height are the first fields of the first chunk.
std::optional<ImageSize> png_size(std::string_view bytes) {
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1A\n";
  constexpr std::size_t kWidth = 16;
  constexpr std::size_t kEnd = 24;
  if (!bytes.starts_with(kSignature) || bytes.size() < kEnd || bytes.substr(12, 4) != "IHDR") {
    return std::nullopt;
  }
  return ImageSize{big_endian(bytes.substr(kWidth, 4)), big_endian(bytes.substr(kWidth + 4, 4))};
}

/// Skips white space and comments, which end with their line.
std::string_view next_token(std::string_view text) {
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\n\v\f\r"), text.size()));
    if (!text.starts_with('#')) return text;
    text.remove_prefix(std::min(text.find_first_of("\r\n"), text.size()));
  }
}

/// Takes a decimal number: 0 where there is none, the largest possible one for too many digits.
std::uint64_t take_number(std::string_view& text) {
  text = next_token(text);
  std::uint64_t number = 0;
  const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem == std::errc::result_out_of_range) number = std::numeric_limits<std::uint64_t>::max();
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return number;
}

/// Netpbm's pgm(5) and ppm(5): P5 or P6, width, height.
std::optional<ImageSize> pnm_size(std::string_view bytes) {
  if (!bytes.starts_with("P5") && !bytes.starts_with("P6")) return std::nullopt;
  bytes.remove_prefix(2);
  ImageSize size;
  size.width = take_number(bytes);
  size.height = take_number(bytes);
  return size;
}

}  // namespace

std::optional<ImageSize> declared_size(std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto png = png_size(text);
  return png ? png : pnm_size(text);
}

}  // namespace glidar::import
