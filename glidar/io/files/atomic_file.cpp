// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/atomic_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/file_sync.hpp>
#include <glidar/io/files/unfinished_files.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace glidar {
namespace {

/// A block stays in a core's cache until the system has copied it.
constexpr std::size_t kPieceBytes = std::size_t{1} << 18;
[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int code) {
  const std::string reason = std::generic_category().message(code);
  std::string remedy;
  if (code == ENOSPC || code == EDQUOT || code == EFBIG)
    remedy = "make room or write to another folder; no part of this file remains";
  if (code == ENOENT) remedy = "create the folder first";
  if (code == EACCES || code == EPERM || code == EROFS) remedy = "write to another folder";
  throw Error({path.string(), fmt::format("cannot {}: {}", what, reason), "", remedy});
}

/// Error for an open file descriptor, to which bytes were written already.
[[noreturn]] void fail_sent(const std::filesystem::path& path, int code) {
  throw Error({path.string(),
               fmt::format("cannot write: {}", std::generic_category().message(code)), "",
               "the data sent so far is incomplete; write to a file instead"});
}

/// A temporary file, listed as unfinished.
struct Temporary {
  std::filesystem::path name;
  int descriptor = -1;
  int slot = -1;  ///< in the list; -1: the list is full
};

/// A new, exclusively opened file in `folder`. It is listed before it exists, so that a
/// signal at any moment leaves no file.
Temporary open_temporary(const std::filesystem::path& folder, const std::filesystem::path& wanted,
                         mode_t mode) {
  // Another thread soon disconnects clients that use up all descriptors.
  constexpr unsigned kMaxWaits = 200;
  constexpr std::chrono::milliseconds kWait{10};
  unsigned waits = 0;
  for (unsigned attempt = 0;; ++attempt) {
    std::filesystem::path name = folder / fmt::format(".glidar-{}-{}.tmp", ::getpid(), attempt);
    std::error_code ignored;
    if (std::filesystem::exists(name, ignored)) continue;  // another file of this process
    const int slot = list_unfinished(name.native());
    const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    const int code = errno;
    if (descriptor >= 0) return {std::move(name), descriptor, slot};
    unlist_unfinished(slot);
    if ((code == EMFILE || code == ENFILE) && waits++ < kMaxWaits) {
      std::this_thread::sleep_for(kWait);
      continue;
    }
    if (code != EEXIST && code != EINTR) fail(wanted, "create a file in this folder", code);
  }
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path, Permissions permissions) : path_(path) {
  std::error_code ignored;  // an inaccessible path fails below with the reason
  if (std::filesystem::is_directory(path, ignored))
    throw Error({path.string(), "is a folder", "a file name"});
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    throw Error({path.string(), "is a device, pipe or socket", "a regular file, or a new name"});
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  buffer_.resize(kPieceBytes);
  constexpr mode_t kDefault = 0666;
  constexpr mode_t kOwner = 0600;
  Temporary made =
      open_temporary(folder, path, permissions == Permissions::owner_only ? kOwner : kDefault);
  temporary_ = std::move(made.name);
  descriptor_ = made.descriptor;
  slot_ = made.slot;
}

AtomicFile::AtomicFile(int target, const std::filesystem::path& name)
    : path_(name), target_(target) {
  buffer_.resize(kPieceBytes);
  // unnamed, so that it disappears when the program ends; a file, because formats seek back
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  if (!file) fail(path_, "create a temporary file", errno);
  descriptor_ = ::fcntl(::fileno(file.get()), F_DUPFD_CLOEXEC, 0);
  if (descriptor_ < 0) fail(path_, "create a temporary file", errno);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  unlist_unfinished(slot_);
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const std::span<std::byte> to = reserve_space(1);
    const std::size_t now = std::min(to.size(), bytes.size());
    std::memcpy(to.data(), bytes.data(), now);
    take(now);
    bytes = bytes.subspan(now);
  }
}

std::span<std::byte> AtomicFile::reserve_space(std::size_t min_size) {
  write_whole_pieces();
  if (buffer_.size() - filled_ < min_size) buffer_.resize(filled_ + min_size);
  return std::span(buffer_).subspan(filled_);
}

void AtomicFile::take(std::size_t count) {
  filled_ += count;
  position_ += count;
}

void AtomicFile::write(std::string_view text) {
  write(std::as_bytes(std::span(text)));
}

void AtomicFile::seek(std::uint64_t offset) {
  flush();
  if (::lseek(descriptor_, static_cast<off_t>(offset), SEEK_SET) < 0) fail(path_, "seek", errno);
  position_ = offset;
}

void AtomicFile::finish() {
  if (descriptor_ < 0) return;
  if (failure_ != 0) fail(path_, "write", failure_);
  flush();
  if (target_ >= 0) return;  // to be read from
  // Some file systems report a full disk or quota only on closing.
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail(path_, "close", errno);
}

void AtomicFile::commit() {
  finish();
  if (target_ >= 0) return send();
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, "rename", errno);
  temporary_.clear();
  unlist_unfinished(std::exchange(slot_, -1));
}

void AtomicFile::commit_durably() {
  if (target_ >= 0) return commit();
  flush();
  sync_file(descriptor_, path_);
  commit();
  sync_folder_of(path_);
}

void AtomicFile::send() const {
  if (::lseek(descriptor_, 0, SEEK_SET) < 0) fail(path_, "read back", errno);
  std::vector<std::byte> piece(kPieceBytes);
  for (;;) {
    const ssize_t count = ::read(descriptor_, piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path_, "read back", errno);
    if (count == 0) return;
    std::span<const std::byte> rest(piece.data(), static_cast<std::size_t>(count));
    while (!rest.empty()) {
      const ssize_t written = ::write(target_, rest.data(), rest.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0 && errno == EPIPE)
        throw ClosedPipe({path_.string(), "its reader has closed it"});
      if (written < 0) fail_sent(path_, errno);
      rest = rest.subspan(static_cast<std::size_t>(written));
    }
  }
}

void AtomicFile::flush() {
  write_through(std::span(buffer_).first(filled_));
  filled_ = 0;
}

void AtomicFile::write_whole_pieces() {
  const std::size_t whole = filled_ / kPieceBytes * kPieceBytes;
  if (whole == 0) return;
  write_through(std::span(buffer_).first(whole));
  std::memmove(buffer_.data(), buffer_.data() + whole, filled_ - whole);
  filled_ -= whole;
}

void AtomicFile::write_through(std::span<const std::byte> bytes) {
  if (failure_ != 0) fail(path_, "write", failure_);
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_, "write", failure_ = errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

}  // namespace glidar
