// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/atomic_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/cache_folder.hpp>
#include <glidar/io/files/unique_fd.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace glidar {
namespace {

constexpr std::size_t kSlots = 128;
constexpr std::size_t kSlotPathBytes = 4096;

// States of a slot; int, because only plain atomics are sure to work in a signal handler.
constexpr int kFree = 0;
constexpr int kFilling = 1;
constexpr int kListed = 2;
constexpr int kRemoving = 3;

/// A temporary file's name in memory that a signal handler can read without allocation and locks.
struct Slot {
  std::atomic<int> state{kFree};
  std::array<char, kSlotPathBytes> path{};
};
static_assert(std::atomic<int>::is_always_lock_free, "used in signal handlers");

// Global, because a signal handler has no arguments.
constinit std::array<Slot, kSlots> unfinished{};

}  // namespace

int list_unfinished(const std::string& path) {
  if (path.size() >= kSlotPathBytes) return -1;
  for (std::size_t i = 0; i < kSlots; ++i) {
    int expected = kFree;
    if (!unfinished[i].state.compare_exchange_strong(expected, kFilling)) continue;
    std::memcpy(unfinished[i].path.data(), path.c_str(), path.size() + 1);
    unfinished[i].state.store(kListed);
    return static_cast<int>(i);
  }
  return -1;
}

/// A slot that a handler is reading is not changed, because the process is ending.
void unlist_unfinished(int slot) {
  if (slot < 0) return;
  int expected = kListed;
  unfinished[static_cast<std::size_t>(slot)].state.compare_exchange_strong(expected, kFree);
}

void remove_unfinished_files() noexcept {
  const int saved_errno = errno;
  for (Slot& slot : unfinished) {
    int expected = kListed;
    if (slot.state.compare_exchange_strong(expected, kRemoving)) ::unlink(slot.path.data());
  }
  // Folders without other files are empty now, the innermost first; for files this fails.
  for (std::size_t i = kSlots; i-- > 0;) {
    if (unfinished[i].state.load() == kRemoving) ::rmdir(unfinished[i].path.data());
  }
  errno = saved_errno;
}

namespace {

/// A block stays in a core's cache until the system has copied it.
constexpr std::size_t kPieceBytes = std::size_t{1} << 18;

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int code) {
  const std::string reason = std::generic_category().message(code);
  std::string remedy;
  if (code == ENOSPC || code == EDQUOT)
    remedy = "make room or write to another folder; no part of this file remains";
  if (code == EFBIG)
    remedy =
        "raise the limit on the size of files (ulimit -f), or write to a file system for "
        "larger files; no part of this file remains";
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

/// Calls make(), which returns -1 and sets errno if it fails, and again while other files use up
/// the descriptors: another thread soon disconnects clients that do.
template <class Make>
int with_descriptors(const Make& make) {
  constexpr unsigned kMaxWaits = 200;
  constexpr std::chrono::milliseconds kWait{10};
  for (unsigned waits = 0;; ++waits) {
    const int made = make();
    const bool is_full = made < 0 && (errno == EMFILE || errno == ENFILE) && waits < kMaxWaits;
    if (!is_full && (made >= 0 || errno != EINTR)) return made;
    if (is_full) std::this_thread::sleep_for(kWait);
  }
}

/// A name that make(name) gave to a file in `folder`. It is listed before the file has it, so that
/// a signal at any moment leaves no file.
template <class Make>
Temporary make_temporary(const std::filesystem::path& folder, const std::filesystem::path& wanted,
                         const Make& make) {
  for (unsigned attempt = 0;; ++attempt) {
    std::filesystem::path name = folder / fmt::format(".glidar-{}-{}.tmp", ::getpid(), attempt);
    std::error_code ignored;
    if (std::filesystem::exists(name, ignored)) continue;  // another file of this process
    const int slot = list_unfinished(name.native());
    const int made = with_descriptors([&] { return make(name); });
    const int code = errno;
    if (made >= 0) return {std::move(name), made, slot};
    unlist_unfinished(slot);
    if (code != EEXIST) fail(wanted, "create a file in this folder", code);
  }
}

/// A file without a name, which disappears however the program ends; -1: this file system has none.
int open_unnamed(const std::filesystem::path& folder, const std::filesystem::path& wanted,
                 mode_t mode) {
  if (::access("/proc/self/fd", X_OK) != 0) return -1;  // it gets its name through this folder
  const int descriptor = with_descriptors(
      [&] { return ::open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, mode); });
  const bool is_known = errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL;
  if (descriptor < 0 && is_known) fail(wanted, "create a file in this folder", errno);
  return descriptor;
}

/// Where a file of this name is written: a symbolic link stays, and its target is written.
std::filesystem::path followed(const std::filesystem::path& path) {
  constexpr int kMaxLinks = 40;
  std::filesystem::path at = std::filesystem::absolute(path);
  std::error_code failure;
  for (int links = 0; std::filesystem::is_symlink(at, failure); ++links) {
    if (links == kMaxLinks) fail(path, "follow this symbolic link", ELOOP);
    at = at.parent_path() / std::filesystem::read_symlink(at, failure);
    if (failure) fail(path, "follow this symbolic link", failure.value());
  }
  return at;
}

/// 0 or an error number. Not repeated after an error other than EINTR: Linux reports a lost write
/// once, so that the next call would succeed without the data.
int sync(int descriptor) {
  while (::fsync(descriptor) != 0) {
    if (errno != EINTR) return errno;
  }
  return 0;
}

[[noreturn]] void fail_sync(const std::filesystem::path& path, const char* what, int code,
                            const char* remedy) {
  const bool is_full = code == ENOSPC || code == EDQUOT;
  throw Error({path.string(),
               fmt::format("cannot {}: {}", what, std::generic_category().message(code)), "",
               is_full ? "make room or write to another folder" : remedy});
}

/// Waits until the data of an open file is on the disk. `path` appears in errors. Throws Error;
/// then it is unknown which bytes are on the disk.
void sync_file(int descriptor, const std::filesystem::path& path) {
  const int error = sync(descriptor);
  if (error != 0) {
    fail_sync(path, "write to the disk (fsync)", error,
              "check the disk; no part of this file remains");
  }
}

/// Waits until the names in the folder of this file are on the disk. Ignores file systems that
/// cannot sync a folder, such as some network file systems. Throws Error.
void sync_folder_of(const std::filesystem::path& path) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  const UniqueFd descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  const int error = descriptor ? sync(descriptor.get()) : errno;
  // POSIX lets a file system reject it (EINVAL); FUSE and network file systems do (ENOTSUP).
  if (error == 0 || (descriptor && (error == EINVAL || error == ENOTSUP))) return;
  fail_sync(path, "write its folder to the disk (fsync)", error,
            "the file is in place and complete, but may not survive power loss; check the disk, or "
            "omit --durable");
}

/// Files without a name stay open until they get one, but only while there are few descriptors.
constexpr int kMaxUnnamed = 128;

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path, Permissions permissions)
    : path_(path), destination_(followed(path)) {
  std::error_code ignored;  // an inaccessible path fails below with the reason
  if (std::filesystem::is_directory(path, ignored))
    throw Error({path.string(), "is a folder", "a file name"});
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    throw Error({path.string(), "is a device, pipe or socket", "a regular file, or a new name"});
  const std::filesystem::path folder = destination_.parent_path();
  buffer_.resize(kPieceBytes);
  const mode_t mode = permissions == Permissions::owner_only ? 0600 : 0666;
  descriptor_ = open_unnamed(folder, path, mode);
  if (descriptor_ >= 0) return;
  Temporary made = make_temporary(folder, path, [&](const std::filesystem::path& name) {
    return ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  });
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
  if (failure_ != 0) fail(path_, "write", failure_);
  if (descriptor_ < 0) return;
  flush();
  if (target_ >= 0) return;  // to be read from
  if (!temporary_.empty() || descriptor_ >= kMaxUnnamed) close_named();
}

void AtomicFile::close_named() {
  if (temporary_.empty()) {
    const std::string own = fmt::format("/proc/self/fd/{}", descriptor_);
    Temporary made =
        make_temporary(destination_.parent_path(), path_, [&](const std::filesystem::path& name) {
          return ::linkat(AT_FDCWD, own.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW);
        });
    temporary_ = std::move(made.name);
    slot_ = made.slot;
  }
  // Some file systems report a full disk or quota only on closing.
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR)
    fail(path_, "close", failure_ = errno);
}

void AtomicFile::commit() {
  finish();
  if (target_ >= 0) return send();
  if (descriptor_ >= 0) close_named();
  if (std::rename(temporary_.c_str(), destination_.c_str()) != 0) fail(path_, "rename", errno);
  temporary_.clear();
  unlist_unfinished(std::exchange(slot_, -1));
}

void AtomicFile::commit_durably() {
  if (target_ >= 0) return commit();
  flush();
  sync_file(descriptor_, path_);
  commit();
  sync_folder_of(destination_);
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

std::filesystem::path real_path(const std::filesystem::path& path) {
  const std::filesystem::path whole = std::filesystem::absolute(path);
  std::error_code no_such_folder;
  const std::filesystem::path folder =
      std::filesystem::canonical(whole.parent_path(), no_such_folder);
  return no_such_folder ? whole.lexically_normal() : folder / whole.filename();
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code no_such_file;  // a missing file equals only its own name
  return real_path(a) == real_path(b) || std::filesystem::equivalent(a, b, no_such_file);
}

std::vector<std::string> files_of(const Scene& scene) {
  std::vector<std::string> files;
  for (const MeshSource& source : scene.sources) {
    files.insert(files.end(), source.files.begin(), source.files.end());
  }
  return files;
}

void refuse_overwrite_of_inputs(std::span<const std::string> read,
                                const std::filesystem::path& output) {
  std::error_code ignored;  // inaccessible files are compared by name
  const std::filesystem::path name = real_path(output);
  const bool is_there = std::filesystem::exists(output, ignored);
  const auto is_it = [&](const std::string& file) {
    return real_path(file) == name ||
           (is_there && std::filesystem::equivalent(file, output, ignored));
  };
  if (std::none_of(read.begin(), read.end(), is_it)) return;
  throw Error({.where = output.string(),
               .found = "is an input file, or another output writes it",
               .remedy = "choose another name"});
}

namespace {

void remove_outdated(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure)) return;
  std::filesystem::remove(path, failure);
  if (!failure) return;
  throw Error({path.string(),
               "cannot remove this file, which belongs to an earlier output: " + failure.message(),
               "", "write to another folder"});
}

}  // namespace

AtomicFile& StagedFiles::add(const std::filesystem::path& path) {
  refuse_overwrite_of_inputs(protected_, path);
  return files_.emplace_back(path);
}

void StagedFiles::add_folder(const std::filesystem::path& path) {
  std::error_code failure;
  if (std::filesystem::create_directory(path, failure)) {
    const std::filesystem::path whole = std::filesystem::absolute(path);
    folders_.push_back({whole, list_unfinished(whole.native())});
  }
  if (!failure) return;
  throw Error({path.string(), "cannot create this folder: " + failure.message(), "",
               "write to another folder"});
}

void StagedFiles::commit() {
  std::optional<FolderLock> lock;
  if (!is_locked_ && files_.size() + removals_.size() > 1 && !files_.empty())
    lock.emplace(std::filesystem::absolute(files_.front().path()).parent_path());
  for (const std::filesystem::path& path : removals_) remove_outdated(path);
  removals_.clear();
  for (auto file = files_.rbegin(); file != files_.rend(); ++file) file->commit();
  files_.clear();
  unlist_folders();
}

void StagedFiles::clear() noexcept {
  files_.clear();
  removals_.clear();
  std::error_code ignored;  // a folder that is in use by now stays
  for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder)
    std::filesystem::remove(folder->path, ignored);
  unlist_folders();
}

void StagedFiles::unlist_folders() noexcept {
  for (const NewFolder& folder : folders_) unlist_unfinished(folder.slot);
  folders_.clear();
}

}  // namespace glidar
