// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the library and the program: opens input files.

#include <glidar/io/files/unique_fd.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace glidar {

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

}  // namespace glidar
