// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/cache_folder.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/content_hash.hpp>
#include <glidar/io/model/model.hpp>

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace glidar {

namespace {

enum class Result { granted, taken, unavailable };

Result lock(const UniqueFd& descriptor) {
  while (::flock(descriptor.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return Result::taken;
    if (errno != EINTR) return Result::unavailable;
  }
  return Result::granted;
}

UniqueFd open_folder(const std::filesystem::path& folder) {
  return UniqueFd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) {
  constexpr std::chrono::minutes kMaxWait{1};
  constexpr std::chrono::microseconds kPause{200};  // other processes hold it for some renames only
  UniqueFd descriptor = open_folder(folder);
  if (!descriptor) return;  // a folder that is writable but not readable
  const auto end = std::chrono::steady_clock::now() + kMaxWait;
  for (Result result = lock(descriptor); result != Result::granted; result = lock(descriptor)) {
    if (result == Result::unavailable) return;
    if (std::chrono::steady_clock::now() > end) {
      throw Error({folder.string(), "another program has locked this folder for a minute", "",
                   "stop that program, or write to another folder"});
    }
    std::this_thread::sleep_for(kPause);
  }
  descriptor_ = std::move(descriptor);
}

FolderLock FolderLock::of_run(const std::filesystem::path& folder) {
  FolderLock held;
  UniqueFd descriptor = open_folder(folder);
  if (!descriptor) return held;
  const Result result = lock(descriptor);
  if (result == Result::taken) {
    throw Error({folder.string(), "another run writes to this folder now", "",
                 "wait until it has ended, or write to another folder"});
  }
  if (result == Result::granted) held.descriptor_ = std::move(descriptor);
  return held;
}

namespace {

namespace fs = std::filesystem;

constexpr const char* kLimitVariable = "GLIDAR_CACHE_LIMIT_MIB";
constexpr std::uint64_t kDefaultLimitMib = 2048;
constexpr std::uint64_t kMaxMib = std::uint64_t{1} << 40U;
constexpr std::string_view kEnding = ".model";
constexpr std::size_t kKeyDigits = 32;
constexpr mode_t kOwnerOnly = S_IRWXU;

std::string reason(int error) {
  return std::strerror(error);
}

/// Creates the folder and its parents for their owner only, as required by the XDG base directory
/// specification. 0 or an error number.
int make_private(const fs::path& path) {
  if (::mkdir(path.c_str(), kOwnerOnly) == 0 || errno == EEXIST) return 0;
  if (errno != ENOENT || !path.has_parent_path() || path.parent_path() == path) return errno;
  const int error = make_private(path.parent_path());
  if (error != 0) return error;
  return ::mkdir(path.c_str(), kOwnerOnly) == 0 || errno == EEXIST ? 0 : errno;
}

/// Why a folder with these properties must not be used; empty: it may be used.
std::string distrust(const struct stat& info, const fs::path& path) {
  if (info.st_uid != ::geteuid()) {
    return fmt::format(
        "the cache folder {} belongs to another user (id {}), so models are not cached; use a "
        "folder of your own with --cache-folder, or --no-cache",
        path.string(), info.st_uid);
  }
  if ((info.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return fmt::format(
        "the cache folder {} is accessible to other users (mode {:04o}), so models are not cached; "
        "run: chmod 700 '{}' (or use another with --cache-folder)",
        path.string(), info.st_mode & 07777U, path.string());
  }
  return "";
}

bool is_key(std::string_view text) {
  return text.size() == kKeyDigits &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_entry(std::string_view name) {
  return name.ends_with(kEnding) && is_key(name.substr(0, name.size() - kEnding.size()));
}

/// The name of an entry, a dot, and a suffix: a complete or incomplete temporary file.
bool is_temporary(std::string_view name) {
  const std::size_t entry = kKeyDigits + kEnding.size();
  return name.size() > entry && name[entry] == '.' && is_entry(name.substr(0, entry));
}

std::vector<std::string> names_in(const CacheFolder& folder) {
  const int again = ::openat(folder.fd.get(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const std::unique_ptr<DIR, int (*)(DIR*)> listing(again < 0 ? nullptr : ::fdopendir(again),
                                                    ::closedir);
  std::vector<std::string> names;
  if (listing == nullptr) return names;
  while (const dirent* entry = ::readdir(listing.get())) names.emplace_back(entry->d_name);
  return names;
}

/// A writer holds a lock on its temporary file, which the system releases when the writer dies.
void remove_stale_files(const CacheFolder& folder) {
  for (const std::string& name : names_in(folder)) {
    if (!is_temporary(name)) continue;
    const UniqueFd file(
        ::openat(folder.fd.get(), name.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    if (file && ::flock(file.get(), LOCK_EX | LOCK_NB) == 0) {
      ::unlinkat(folder.fd.get(), name.c_str(), 0);
    }
  }
}

struct Used {
  std::string name;
  std::uint64_t bytes = 0;
  timespec at{};
};

bool is_earlier(const Used& a, const Used& b) {
  return a.at.tv_sec != b.at.tv_sec ? a.at.tv_sec < b.at.tv_sec : a.at.tv_nsec < b.at.tv_nsec;
}

/// Removes the least recently used entries, but never `kept`.
void evict(const CacheFolder& folder, std::uint64_t limit_bytes, const std::string& kept) {
  std::vector<Used> entries;
  std::uint64_t total = 0;
  for (const std::string& name : names_in(folder)) {
    struct stat info {};
    if (!is_entry(name) ||
        ::fstatat(folder.fd.get(), name.c_str(), &info, AT_SYMLINK_NOFOLLOW) != 0) {
      continue;
    }
    total += static_cast<std::uint64_t>(info.st_size);
    if (name != kept) {
      entries.push_back({name, static_cast<std::uint64_t>(info.st_size), info.st_mtim});
    }
  }
  std::sort(entries.begin(), entries.end(), is_earlier);
  for (const Used& entry : entries) {
    if (total <= limit_bytes) return;
    if (::unlinkat(folder.fd.get(), entry.name.c_str(), 0) == 0) total -= entry.bytes;
  }
}

/// A temporary file that this process has locked; the destructor removes it unless it was renamed.
class TemporaryEntry {
 public:
  TemporaryEntry(const CacheFolder& folder, const std::string& entry) : folder_(folder.fd.get()) {
    constexpr int kAttempts = 100;
    for (int i = 0; i < kAttempts && !fd_; ++i) {
      name_ = fmt::format("{}.{:016x}", entry, random());
      UniqueFd file(::openat(folder_, name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                             S_IRUSR | S_IWUSR));
      error_ = errno;
      if (!file && error_ != EEXIST) return;
      if (file && is_ours(file)) fd_ = std::move(file);
    }
  }
  TemporaryEntry(const TemporaryEntry&) = delete;
  TemporaryEntry& operator=(const TemporaryEntry&) = delete;
  ~TemporaryEntry() {
    if (fd_ && !is_renamed_) ::unlinkat(folder_, name_.c_str(), 0);
  }

  [[nodiscard]] int fd() const { return fd_.get(); }
  /// 0 or an error number.
  [[nodiscard]] int error() const { return fd_ ? 0 : error_; }
  /// 0 or an error number; some file systems report a full disk or quota only on closing.
  [[nodiscard]] int error_of_closing() const {
    const int copy = ::fcntl(fd_.get(), F_DUPFD_CLOEXEC, 0);  // the file stays locked
    if (copy < 0) return errno;
    return ::close(copy) == 0 || errno == EINTR ? 0 : errno;
  }
  int rename_to(const std::string& entry) {
    is_renamed_ = ::renameat(folder_, name_.c_str(), folder_, entry.c_str()) == 0;
    return is_renamed_ ? 0 : errno;
  }

 private:
  static std::uint64_t random() {
    std::uint64_t value = 0;
    [[maybe_unused]] const ssize_t got = ::getrandom(&value, sizeof value, 0);
    return value;
  }
  /// Before it was locked, another process may have considered the file abandoned.
  static bool is_ours(const UniqueFd& file) {
    ::flock(file.get(), LOCK_EX);
    struct stat info {};
    return ::fstat(file.get(), &info) == 0 && info.st_nlink > 0;
  }

  int folder_;
  std::string name_;
  UniqueFd fd_;
  int error_ = 0;
  bool is_renamed_ = false;
};

}  // namespace

std::optional<fs::path> cache_folder_path(const ModelOptions& options) {
  if (!options.cache_folder.empty()) return options.cache_folder;
  const auto variable = [](const char* name) -> fs::path {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
  };
  // The XDG base directory specification: relative values are invalid.
  if (const fs::path xdg = variable("XDG_CACHE_HOME"); xdg.is_absolute()) return xdg / "glidar";
  if (const fs::path home = variable("HOME"); home.is_absolute()) return home / ".cache" / "glidar";
  return std::nullopt;
}

CacheFolder open_cache_folder(const fs::path& path) {
  CacheFolder folder{{}, path, ""};
  const int unmade = make_private(path);
  UniqueFd fd(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  struct stat info {};
  if (!fd || ::fstat(fd.get(), &info) != 0) {
    folder.problem = fmt::format("the cache folder {} cannot be used: {}", path.string(),
                                 reason(unmade != 0 ? unmade : errno));
    return folder;
  }
  folder.problem = distrust(info, path);
  if (folder.problem.empty()) folder.fd = std::move(fd);
  return folder;
}

std::uint64_t cache_limit_bytes() {
  const char* text = std::getenv(kLimitVariable);
  std::uint64_t mib = kDefaultLimitMib;
  if (text != nullptr && *text != '\0') {
    const char* end = text + std::strlen(text);
    const auto [rest, error] = std::from_chars(text, end, mib);
    if (error != std::errc() || rest != end || mib > kMaxMib) {
      throw Error({.where = kLimitVariable,
                   .found = std::string(text).substr(0, 60),
                   .allowed = "a whole number of MiB, from 0 to 2^40",
                   .remedy = "unset it for the default, 2048"});
    }
  }
  return mib << 20U;
}

UniqueFd open_entry(const CacheFolder& folder, const std::string& name) {
  UniqueFd fd(
      ::openat(folder.fd.get(), name.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat info {};
  const bool is_trusted = fd && ::fstat(fd.get(), &info) == 0 && S_ISREG(info.st_mode) &&
                          info.st_uid == ::geteuid() && (info.st_mode & (S_IWGRP | S_IWOTH)) == 0;
  return is_trusted ? std::move(fd) : UniqueFd();
}

void touch_entry(const UniqueFd& entry) {
  ::futimens(entry.get(), nullptr);
}

std::string store_entry(const CacheFolder& folder, const std::string& name,
                        std::uint64_t limit_bytes, const std::function<void(int fd)>& write) {
  const auto because = [&folder](const std::string& why) {
    return fmt::format("the cache {} cannot be written: {}", folder.path.string(), why);
  };
  remove_stale_files(folder);
  TemporaryEntry temporary(folder, name);
  if (temporary.error() != 0) return because(reason(temporary.error()));
  try {
    write(temporary.fd());
  } catch (const Error& failure) {
    return because(failure.parts().found);
  }
  struct stat info {};
  ::fstat(temporary.fd(), &info);
  if (static_cast<std::uint64_t>(info.st_size) > limit_bytes) {
    return fmt::format("the model is not cached: it takes {} MiB, the limit of all is {} MiB ({})",
                       (info.st_size + (1 << 20U) - 1) >> 20U, limit_bytes >> 20U, kLimitVariable);
  }
  int error = temporary.error_of_closing();
  if (error == 0) error = temporary.rename_to(name);
  if (error != 0) return because(reason(error));
  evict(folder, limit_bytes, name);
  return "";
}

}  // namespace glidar
