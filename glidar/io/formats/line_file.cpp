// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/line_file.hpp>

#include <glidar/core/error.hpp>

namespace glidar {

LineFile::LineFile(const std::filesystem::path& path, const InputFileKind& kind,
                   std::size_t max_line_bytes)
    : path_(path), file_(open_input_file(path, kind)), max_line_bytes_(max_line_bytes) {}

/// Appends to the buffer after removing returned lines; false: end of file.
bool LineFile::fill() {
  constexpr std::size_t kPiece = std::size_t{1} << 16U;
  buffer_.erase(0, at_);
  at_ = 0;
  const std::size_t before = buffer_.size();
  buffer_.resize(before + kPiece);
  const std::size_t count = read_some(file_, path_, buffer_.data() + before, kPiece);
  buffer_.resize(before + count);
  return count > 0;
}

bool LineFile::next(std::string& line) {
  std::size_t searched = at_;
  for (;;) {
    const std::size_t end = buffer_.find('\n', searched);
    if (end != std::string::npos || is_at_end_) {
      if (end == std::string::npos && at_ == buffer_.size()) return false;
      line = buffer_.substr(at_, end == std::string::npos ? end : end - at_);
      at_ = end == std::string::npos ? buffer_.size() : end + 1;
      return true;
    }
    const std::size_t waiting = buffer_.size() - at_;
    if (waiting > max_line_bytes_) {
      throw Error({path_.string(),
                   "a line of more than " + std::to_string(max_line_bytes_ >> 20U) + " MiB",
                   "shorter lines"});
    }
    is_at_end_ = !fill();
    searched = waiting;
  }
}

}  // namespace glidar
