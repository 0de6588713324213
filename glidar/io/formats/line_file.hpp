// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the library: reads a text file line by line.

#include <glidar/io/files/input_file.hpp>

#include <cstddef>
#include <filesystem>
#include <string>

namespace glidar {

/// The lines of a regular file of any size.
class LineFile {
 public:
  /// Throws Error like open_input_file. Lines have at most `max_line_bytes`.
  LineFile(const std::filesystem::path& path, const InputFileKind& kind,
           std::size_t max_line_bytes);

  /// Reads the next line without its terminator; false: end of file. Throws Error when it is too
  /// long, or cannot be read.
  bool next(std::string& line);

 private:
  bool fill();

  std::filesystem::path path_;
  InputFile file_;
  std::size_t max_line_bytes_;
  std::string buffer_;
  std::size_t at_ = 0;  ///< start of the next line in the buffer
  bool is_at_end_ = false;
};

}  // namespace glidar
