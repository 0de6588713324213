// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/unique_fd.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

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
  numbers,     ///< of the accessors of a model, each as often as it is read
  instances,   ///< of the meshes of a model
  copies,      ///< vertices and triangles of all instances but the first of each mesh
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
  /// "more than 5096 topics": what an error of the budget has found.
  [[nodiscard]] std::string excess(Budget what) const;
  /// The error of take().
  [[noreturn]] void fail(Budget what, const std::string& place) const;
  void give_back(Budget what, std::uint64_t amount) { used_[index(what)] -= amount; }
  /// A further file of the same input was opened.
  void add_input(std::uint64_t bytes) { input_bytes_ += bytes; }

  /// Counts a name. Throws Error also when it is longer than kMaxNameBytes.
  void take_name(std::uint64_t bytes, const std::string& place);
  static constexpr std::size_t kMaxNameBytes = 4096;

  [[nodiscard]] std::uint64_t limit(Budget what) const;

 private:
  static constexpr std::size_t kBudgets = static_cast<std::size_t>(Budget::copies) + 1;
  static constexpr std::size_t index(Budget what) { return static_cast<std::size_t>(what); }

  std::uint64_t input_bytes_;
  std::array<std::uint64_t, kBudgets> used_{};
};

/// The expected type of a file, for errors.
struct InputFileKind {
  std::string name;  ///< "a YAML file"
  std::uintmax_t max_mib = 1;
  std::string remedy_if_larger;
};

/// A file that is open for reading.
struct InputFile {
  UniqueFd descriptor;
  std::size_t size = 0;  ///< bytes, when it was opened
};

/// Opens a regular file of at most kind.max_mib. A pipe or device is rejected
/// without blocking. Throws Error: missing (with the nearest name in its folder), not a
/// regular file, too large, not readable.
InputFile open_input_file(const std::filesystem::path& path, const InputFileKind& kind);

/// The whole file. Throws Error like open_input_file, also when it cannot be read completely or
/// grows beyond the limit.
std::string read_input_file(const std::filesystem::path& path, const InputFileKind& kind);

/// The next bytes of an open file, at most `size`; 0 at its end. Throws Error.
std::size_t read_some(const InputFile& file, const std::filesystem::path& path, char* to,
                      std::size_t size);

using TextFileKind = InputFileKind;

/// The whole file, see read_input_file. Throws Error like read_input_file, and when it contains
/// zero bytes.
std::string read_text_file(const std::filesystem::path& file, const TextFileKind& kind);

/// Throws Error, with file and line, when a text is not UTF-8.
void require_utf8(const std::filesystem::path& file, std::string_view text);

/// A word of a file, shortened for an error; see excerpt().
std::string shown(std::string_view word);

/// The name in a path's folder that is most similar to the path's file name; empty when none is
/// similar. For suggestions when a file is missing.
std::string nearest_file(const std::filesystem::path& path);

}  // namespace glidar
