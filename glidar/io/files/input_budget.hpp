// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the library: what one input may make its readers do and keep.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace glidar {

/// What readers count.
enum class Budget : std::uint8_t {
  decompressed_bytes,  ///< by all chunks together, however often each is read
  held_bytes,          ///< in memory together; give_back() when they are freed
  messages,
  topics,
  name_bytes,  ///< of topics, types, fields and the like
  components,  ///< of the fields of a cloud
  values,      ///< of YAML and JSON, with aliases expanded
  steps,       ///< of SQLite's virtual machine
};

/// Limits of one input, a file or a folder with several: each is a constant and a multiple of the
/// size of the input, so that a small file can neither take long nor need much memory. Every reader
/// of the input counts in the same object, before it allocates.
class InputBudget {
 public:
  explicit InputBudget(std::uint64_t input_bytes) : input_bytes_(input_bytes) {}

  /// Counts `amount` more. Throws Error with `place`, which names what is read, when there are more
  /// than the limit.
  void take(Budget what, std::uint64_t amount, const std::string& place) {
    if (!try_take(what, amount)) fail(what, place);
  }
  /// The same for callers with an error of their own: false when there are more than the limit.
  [[nodiscard]] bool try_take(Budget what, std::uint64_t amount) {
    if (amount > limit(what) - used_[index(what)]) return false;
    used_[index(what)] += amount;
    return true;
  }
  /// The error of take().
  [[noreturn]] void fail(Budget what, const std::string& place) const;
  void give_back(Budget what, std::uint64_t amount) { used_[index(what)] -= amount; }

  /// Counts a name. Throws Error also when it is longer than kMaxNameBytes.
  void take_name(std::uint64_t bytes, const std::string& place);
  static constexpr std::size_t kMaxNameBytes = 4096;

  [[nodiscard]] std::uint64_t limit(Budget what) const;

 private:
  static constexpr std::size_t kBudgets = static_cast<std::size_t>(Budget::steps) + 1;
  static constexpr std::size_t index(Budget what) { return static_cast<std::size_t>(what); }

  std::uint64_t input_bytes_;
  std::array<std::uint64_t, kBudgets> used_{};
};

}  // namespace glidar
