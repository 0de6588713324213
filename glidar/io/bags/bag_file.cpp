// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/bag_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/byte_reader.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <system_error>

namespace glidar::bags {
namespace {

constexpr std::uint64_t kWindow = 1U << 16U;

InputFileKind bag_kind() {
  constexpr std::uintmax_t kNoLimit_mib = std::numeric_limits<std::uintmax_t>::max() >> 20U;
  return {"a bag", kNoLimit_mib, ""};
}

}  // namespace

BagFile::BagFile(const std::filesystem::path& path)
    : path_(path), file_(open_input_file(path, bag_kind())) {}

std::string BagFile::place(std::uint64_t offset) const {
  return fmt::format("{}, byte {}", path_.string(), offset);
}

std::span<const std::byte> BagFile::peek(std::uint64_t offset, std::uint64_t size) {
  require_within(offset, size);
  const bool is_held = offset >= window_offset_ && offset - window_offset_ <= window_.size() &&
                       size <= window_.size() - (offset - window_offset_);
  if (!is_held) {
    window_.resize(std::max(size, std::min(kWindow, file_.size - offset)));
    window_offset_ = offset;
    read_at(offset, window_);
  }
  return std::span(window_).subspan(offset - window_offset_, size);
}

Bytes BagFile::read(std::uint64_t offset, std::uint64_t size, Bytes reused) {
  require_within(offset, size);
  reused.resize(size);
  read_at(offset, reused);
  return reused;
}

void BagFile::copy(std::uint64_t offset, std::span<std::byte> to) {
  require_within(offset, to.size());
  const bool follows = offset >= copied_until_ && offset - copied_until_ < kWindow;
  copied_until_ = offset + to.size();
  if (!follows) return read_at(offset, to);
  std::ranges::copy(peek(offset, to.size()), to.begin());
}

void BagFile::require_within(std::uint64_t offset, std::uint64_t size) const {
  if (offset <= file_.size && size <= file_.size - offset) return;
  reject_bag(place(offset),
             fmt::format("{} bytes are missing",
                         size - (file_.size - std::min<std::uint64_t>(offset, file_.size))));
}

void BagFile::read_at(std::uint64_t offset, std::span<std::byte> to) const {
  while (!to.empty()) {
    const ssize_t count =
        ::pread(file_.descriptor.get(), to.data(), to.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      throw Error({path_.string(), "cannot read: " + std::generic_category().message(errno)});
    }
    if (count == 0) reject_bag(place(offset), "the file has become shorter");
    to = to.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

}  // namespace glidar::bags
