// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/npy_head.hpp>

#include <glidar/core/error.hpp>

#include <charconv>
#include <cstring>
#include <string_view>

namespace glidar {
namespace {

constexpr std::size_t kMaxSizes = 5;

/// The text after 'key': in the head's dictionary; empty when it is not there.
std::string_view value_of(std::string_view head, std::string_view key) {
  const std::size_t at = head.find(key);
  if (at == std::string_view::npos) return {};
  const std::size_t colon = head.find(':', at);
  if (colon == std::string_view::npos) return {};
  std::string_view value = head.substr(colon + 1);
  while (value.starts_with(' ')) value.remove_prefix(1);
  return value;
}

std::vector<std::size_t> shape_of(std::string_view head) {
  std::vector<std::size_t> shape;
  std::string_view value = value_of(head, "'shape'");
  value = value.substr(0, value.find(')'));
  while (!value.empty() && shape.size() < kMaxSizes) {
    const char c = value.front();
    std::size_t number = 0;
    const auto [stop, problem] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (problem != std::errc{}) {
      if (c != '(' && c != ',' && c != ' ') return {};
      value.remove_prefix(1);
      continue;
    }
    shape.push_back(number);
    value.remove_prefix(static_cast<std::size_t>(stop - value.data()));
  }
  return shape;
}

}  // namespace

NpyHead read_npy_head(const std::string& where, const std::string& bytes, const NpyTypes& types) {
  constexpr std::string_view kMagic = "\x93NUMPY";
  constexpr std::size_t kShortHead = 10;
  constexpr std::size_t kLongHead = 12;
  const auto byte = [&](std::size_t i) {
    return std::size_t{static_cast<unsigned char>(bytes[i])};
  };
  if (!bytes.starts_with(kMagic) || bytes.size() < kLongHead || byte(6) < 1 || byte(6) > 2) {
    throw Error({where, "no NumPy array", "an .npy file of format 1 or 2", ""});
  }
  const bool is_long = byte(6) == 2;
  std::size_t length = byte(8) + (byte(9) << 8U);
  if (is_long) length += (byte(10) << 16U) + (byte(11) << 24U);
  NpyHead head;
  head.data_at = (is_long ? kLongHead : kShortHead) + length;
  if (head.data_at > bytes.size()) {
    throw Error({where, "the file ends in its head", "a whole .npy file", ""});
  }
  const std::string_view text = std::string_view(bytes).substr(0, head.data_at);
  const std::string_view type = value_of(text, "'descr'");
  for (const NpyType& known : types.types) {
    if (type.starts_with(known.text)) head.number_bytes = known.bytes;
  }
  const bool by_rows = value_of(text, "'fortran_order'").starts_with("False");
  if (head.number_bytes == 0 || !by_rows) {
    throw Error({where, "numbers of another type or order", types.allowed, types.remedy});
  }
  head.shape = shape_of(text);
  return head;
}

void require_npy_numbers(const std::string& where, const NpyHead& head, const std::string& bytes) {
  std::size_t there = (bytes.size() - head.data_at) / head.number_bytes;
  for (const std::size_t size : head.shape) {
    if (size > there) {
      throw Error({where, "fewer numbers than its shape requires", "a whole .npy file", ""});
    }
    if (size > 0) there /= size;
  }
}

double npy_number(const char* data, std::size_t bytes) {
  if (bytes == sizeof(float)) {
    float value = 0.0F;
    std::memcpy(&value, data, sizeof value);
    return double{value};
  }
  double value = 0.0;
  std::memcpy(&value, data, sizeof value);
  return value;
}

}  // namespace glidar
