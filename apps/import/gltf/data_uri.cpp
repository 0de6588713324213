// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf/data_uri.hpp>

#include <glidar/core/text.hpp>
#include <glidar/io/model/texture_search.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace glidar::import::gltf {
namespace {

constexpr std::int8_t kNoDigit = -1;

/// The digit of every character; kNoDigit for others.
constexpr std::array<std::int8_t, 256> make_digits() {
  constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::int8_t, 256> digits{};
  digits.fill(kNoDigit);
  for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
    digits[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::int8_t>(i);
  }
  digits['-'] = 62;
  digits['_'] = 63;
  return digits;
}

constexpr std::array<std::int8_t, 256> kDigits = make_digits();

std::optional<std::string> from_base64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  unsigned count = 0;
  for (const char c : text) {
    const std::int8_t digit = kDigits[static_cast<unsigned char>(c)];
    if (digit == kNoDigit) return std::nullopt;
    bits = (bits << 6U) | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>((bits >> count) & 0xFFU);
  }
  return bytes;
}

}  // namespace

bool is_data_uri(std::string_view uri) {
  return lower_case(uri.substr(0, 5)) == "data:";
}

std::optional<std::string> data_uri_content(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const std::string_view head = uri.substr(0, comma);
  const std::string_view body = uri.substr(comma + 1);
  if (lower_case(head).ends_with(";base64")) {
    const bool is_escaped = body.find('%') != std::string_view::npos;  // "%3D" for "="
    return is_escaped ? from_base64(percent_decoded(std::string(body))) : from_base64(body);
  }
  return percent_decoded(std::string(body));
}

}  // namespace glidar::import::gltf
