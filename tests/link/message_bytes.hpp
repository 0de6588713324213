// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace glidar::testing {

/// A message written byte by byte.
struct MessageBytes {
  std::vector<std::byte> bytes = {};

  MessageBytes& text(std::string_view letters) {
    for (const char letter : letters) bytes.push_back(static_cast<std::byte>(letter));
    return *this;
  }
  MessageBytes& raw(std::initializer_list<unsigned> values) {
    for (const unsigned value : values) bytes.push_back(static_cast<std::byte>(value));
    return *this;
  }
  template <class T>
  MessageBytes& number(T value) {
    const std::size_t at = bytes.size();
    bytes.resize(at + sizeof(T));
    std::memcpy(bytes.data() + at, &value, sizeof(T));
    return *this;
  }
};

}  // namespace glidar::testing
