// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the library: a text that is read line by line.

#include <glidar/io/files/input_file.hpp>

#include <cstddef>
#include <filesystem>
#include <string>

namespace glidar {

/// The lines of a regular file, of any length in all.
class LineFile {
 public:
  /// Throws Error as open_input_file does. Lines may have `max_line_bytes`.
  LineFile(const std::filesystem::path& path, const InputFileKind& kind,
           std::size_t max_line_bytes);

  /// The next line without its end; false: there is none. Throws Error when it is too long, or
  /// cannot be read.
  bool next(std::string& line);

 private:
  bool fill();

  std::filesystem::path path_;
  InputFile file_;
  std::size_t max_line_bytes_;
  std::string buffer_;
  std::size_t at_ = 0;  ///< where in the buffer the next line begins
  bool is_at_end_ = false;
};

}  // namespace glidar
