// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace glidar {

/// What a text file is to be, for errors.
struct TextFileKind {
  std::string name;  ///< "a YAML file"
  std::uintmax_t largest_mib = 1;
  std::string remedy_if_larger;
};

/// The whole file. Throws Error: missing (with the nearest name in its folder), not a regular file,
/// too large, unreadable, or with zero bytes in it.
std::string read_text_file(const std::filesystem::path& file, const TextFileKind& kind);

/// The same for a file that may hold any bytes.
std::string read_binary_file(const std::filesystem::path& file, const TextFileKind& kind);

/// A word of a file, cut and without control characters, fit for one line of an error.
std::string shown(std::string_view word);

}  // namespace glidar
