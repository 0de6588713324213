// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace glidar {

using Hash128 = std::array<std::uint64_t, 2>;

/// XXH3-128 over bytes that are added in blocks. Not cryptographic: it detects changes and
/// corruption.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(ContentHash&&) noexcept;
  ContentHash& operator=(ContentHash&&) noexcept;
  void add(const void* bytes, std::size_t size);
  [[nodiscard]] Hash128 value() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// 32 hexadecimal digits.
std::string hex(const Hash128& hash);

/// Hash of a regular file's content; empty when it cannot be read or is not a regular file.
std::optional<Hash128> hash_file(const std::filesystem::path& path);

}  // namespace glidar
