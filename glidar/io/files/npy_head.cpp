// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/npy_head.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>

namespace glidar {
namespace {

constexpr std::size_t kMaxSizes = 5;

template <typename T>
T load(const char* data) {
  T value{};
  std::memcpy(&value, data, sizeof value);
  return value;
}

template <typename T>
double number_of(const char* data) {
  return static_cast<double>(load<T>(data));
}

/// IEEE 754 binary16: a sign, 5 bits of exponent, 10 of fraction.
double half_number(const char* data) {
  constexpr int kFractionBits = 10;
  constexpr int kMaxExponent = 31;
  constexpr int kMinScale = -24;  // of the smallest number
  const unsigned bits = load<std::uint16_t>(data);
  const int exponent = static_cast<int>((bits >> kFractionBits) & 31U);
  const int fraction = static_cast<int>(bits & 1023U);
  double size = exponent == 0
                    ? std::ldexp(fraction, kMinScale)
                    : std::ldexp((1 << kFractionBits) + fraction, exponent - 1 + kMinScale);
  if (exponent == kMaxExponent) {
    size = fraction == 0 ? std::numeric_limits<double>::infinity()
                         : std::numeric_limits<double>::quiet_NaN();
  }
  return bits >> 15U == 0 ? size : -size;
}

struct NpyType {
  std::string_view name;
  std::size_t bytes;
  double (*number_at)(const char* data);
  bool is_grey_level = false;
};

constexpr std::array<NpyType, 11> kNpyTypes = {{{"'<f8'", 8, number_of<double>},
                                                {"'<f4'", 4, number_of<float>},
                                                {"'<f2'", 2, half_number},
                                                {"'|i1'", 1, number_of<std::int8_t>},
                                                {"'|u1'", 1, number_of<std::uint8_t>, true},
                                                {"'<i2'", 2, number_of<std::int16_t>},
                                                {"'<u2'", 2, number_of<std::uint16_t>, true},
                                                {"'<i4'", 4, number_of<std::int32_t>},
                                                {"'<u4'", 4, number_of<std::uint32_t>},
                                                {"'<i8'", 8, number_of<std::int64_t>},
                                                {"'<u8'", 8, number_of<std::uint64_t>}}};

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

NpyHead read_npy_head(const std::string& where, const std::string& bytes, NpyNumbers accepted) {
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
  const std::string_view name = value_of(text, "'descr'");
  const auto type = std::find_if(kNpyTypes.begin(), kNpyTypes.end(), [&](const NpyType& known) {
    return name.starts_with(known.name) && (known.is_grey_level || accepted == NpyNumbers::real);
  });
  const bool by_rows = value_of(text, "'fortran_order'").starts_with("False");
  if (type == kNpyTypes.end() || !by_rows) {
    const bool is_real = accepted == NpyNumbers::real;
    throw Error({where, "an array of another type or order",
                 is_real ? "floats of 16 to 64 bits or integers, little-endian, row by row"
                         : "uint8 or uint16, little-endian, row by row",
                 std::string("numpy.save(file, numpy.ascontiguousarray(array, dtype='") +
                     (is_real ? "<f8" : "<u2") + "'))"});
  }
  head.number_bytes = type->bytes;
  head.number_at = type->number_at;
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

}  // namespace glidar
