// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/files/input_file.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

namespace glidar::bags {

/// Throws the Error of a damaged bag. `place` is its path, with a byte offset or the like.
[[noreturn]] void reject_bag(const std::string& place, const std::string& found,
                             const std::string& allowed = "a complete bag");

/// Reads numbers and texts from bytes, of which no size is trusted.
class ByteReader {
 public:
  /// `place` appears in errors.
  ByteReader(std::span<const std::byte> bytes, std::string place)
      : bytes_(bytes), place_(std::move(place)) {}

  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }
  [[nodiscard]] const std::string& place() const { return place_; }

  std::span<const std::byte> take(std::uint64_t size) {
    if (size > left()) reject("a record that ends early");
    const std::span<const std::byte> taken = bytes_.subspan(position_, size);
    position_ += size;
    return taken;
  }

  template <class Number>
  requires std::is_integral_v<Number> Number number() {
    Number value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }

  /// A count of bytes as u32, and the bytes.
  std::span<const std::byte> sized() { return take(number<std::uint32_t>()); }

  std::string text() {
    const std::span<const std::byte> bytes = sized();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  /// A text that is a name, which counts in the budget before it is copied.
  std::string name(InputBudget& budget) {
    const std::span<const std::byte> bytes = sized();
    budget.take_name(bytes.size(), place_);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  [[noreturn]] void reject(const std::string& found) const { reject_bag(place_, found); }

 private:
  std::span<const std::byte> bytes_;
  std::string place_;
  std::size_t position_ = 0;
};

}  // namespace glidar::bags
