// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/checksummed_block.hpp>

#include <glidar/core/error.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace glidar {
namespace {

constexpr std::uint64_t kMagic = 0x3142'5241'4449'4C47;  // "GLIDARB1" on a little-endian machine
constexpr std::uint32_t kVersion = 4;  // incremented when the block's format changes
constexpr std::size_t kBuffer = std::size_t{1} << 16U;

void write_all(int fd, const void* data, std::size_t size) {
  const auto* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t put = ::write(fd, at, size);
    if (put < 0 && errno == EINTR) continue;
    if (put < 0 && errno == EFBIG)
      throw FileSizeLimit({.where = "imported data", .found = std::strerror(EFBIG)});
    if (put <= 0) reject_imported_data(std::string("writing failed: ") + std::strerror(errno));
    at += put;
    size -= static_cast<std::size_t>(put);
  }
}

void read_all(int fd, void* data, std::size_t size) {
  auto* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::read(fd, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) reject_imported_data("it ends too early");
    at += got;
    size -= static_cast<std::size_t>(got);
  }
}

}  // namespace

void reject_imported_data(const std::string& found) {
  throw Error({.where = "imported data", .found = found});
}

BlockWriter::BlockWriter(int fd, BlockKind kind)
    : fd_(fd), kind_(kind), head_at_(::lseek(fd, 0, SEEK_CUR)) {
  const BlockHead empty;
  write_all(fd_, &empty, sizeof empty);
  buffer_.reserve(kBuffer);
}

void BlockWriter::bytes(const void* data, std::size_t size) {
  size_ += size;
  if (buffer_.size() + size > kBuffer) flush();
  if (size > kBuffer) {
    hash_.add(data, size);
    write_all(fd_, data, size);
    return;
  }
  const auto* first = static_cast<const std::byte*>(data);
  buffer_.insert(buffer_.end(), first, first + size);
}

void BlockWriter::flush() {
  hash_.add(buffer_.data(), buffer_.size());
  write_all(fd_, buffer_.data(), buffer_.size());
  buffer_.clear();
}

void BlockWriter::finish() {
  flush();
  const BlockHead head{kMagic, kVersion, static_cast<std::uint32_t>(kind_), size_, hash_.value()};
  if (::pwrite(fd_, &head, sizeof head, head_at_) != static_cast<ssize_t>(sizeof head)) {
    reject_imported_data(std::string("writing failed: ") + std::strerror(errno));
  }
}

BlockReader::BlockReader(int fd) : fd_(fd) {
  read_all(fd_, &head_, sizeof head_);
  if (head_.magic != kMagic || head_.version != kVersion)
    reject_imported_data("it has an unknown header");
  struct stat info {};
  const std::int64_t at = ::lseek(fd_, 0, SEEK_CUR);
  if (::fstat(fd_, &info) != 0 || at < 0 || info.st_size < at ||
      static_cast<std::uint64_t>(info.st_size - at) < head_.size) {
    reject_imported_data("it ends too early");
  }
}

void BlockReader::fill() {
  buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBuffer, head_.size - fetched_)));
  read_all(fd_, buffer_.data(), buffer_.size());
  hash_.add(buffer_.data(), buffer_.size());
  fetched_ += buffer_.size();
  next_ = 0;
}

void BlockReader::bytes(void* data, std::size_t size) {
  if (size > remaining()) reject_imported_data("it claims more data than it has");
  taken_ += size;
  auto* to = static_cast<std::byte*>(data);
  while (size > 0) {
    const std::size_t ready = std::min(size, buffer_.size() - next_);
    if (ready > 0) std::memcpy(to, buffer_.data() + next_, ready);
    next_ += ready;
    to += ready;
    size -= ready;
    if (size > kBuffer) {  // bypass the buffer
      read_all(fd_, to, size);
      hash_.add(to, size);
      fetched_ += size;
      return;
    }
    if (size > 0) fill();
  }
}

void BlockReader::finish() {
  if (remaining() != 0) reject_imported_data("it has extra bytes");
  if (hash_.value() != head_.hash) reject_imported_data("its checksum differs");
}

}  // namespace glidar
