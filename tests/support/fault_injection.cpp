// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
//
// A library for LD_PRELOAD: counts a program's calls that write to files below a folder, and makes
// one of them fail, or ends the program there. GLIDAR_FAULT_STATE names the file of a State, which
// tests/support/faults.py writes and reads, and which all processes with that variable share.

#undef _FORTIFY_SOURCE  // its inline functions have the names that are defined here

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

constexpr std::size_t kWordBytes = 16;

/// As faults.py has it.
struct State {
  std::atomic<std::uint64_t> at;     ///< which of the calls fails, from 1; 0: they are only counted
  std::atomic<std::uint64_t> calls;  ///< so far
  std::atomic<std::uint64_t> hits;   ///< calls that failed
  /// open (for writing), write, sync, rename, close, or any.
  std::array<char, kWordBytes> call;
  /// EIO: that call; ENOSPC: that call and those after it, as on a full disk; kill: SIGKILL to the
  /// process group, in the middle of a write.
  std::array<char, kWordBytes> error;
  std::array<char, PATH_MAX> folder;  ///< absolute; calls on files elsewhere are not counted
  std::array<char, PATH_MAX> path;    ///< of the file of the first hit
};

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

/// nullptr: nothing is counted.
State* open_state() {
  using Open = int (*)(const char*, int, ...);
  const char* const path = std::getenv("GLIDAR_FAULT_STATE");
  if (path == nullptr) return nullptr;
  const int file = next<Open>("open")(path, O_RDWR | O_CLOEXEC);
  if (file < 0) return nullptr;
  void* const memory = ::mmap(nullptr, sizeof(State), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  next<int (*)(int)>("close")(file);
  return memory != MAP_FAILED ? static_cast<State*>(memory) : nullptr;
}

State* state() {
  static State* const only = open_state();
  return only;
}

std::string path_of(int descriptor) {
  std::array<char, PATH_MAX> path{};
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t length = ::readlink(link.c_str(), path.data(), path.size());
  return length > 0 ? std::string(path.data(), static_cast<std::size_t>(length)) : "";
}

std::string path_of(int folder, const char* name) {
  if (*name == '/') return name;
  std::array<char, PATH_MAX> here{};
  const std::string base = folder != AT_FDCWD                              ? path_of(folder)
                           : ::getcwd(here.data(), here.size()) != nullptr ? here.data()
                                                                           : "";
  return base + "/" + name;
}

bool is_counted(std::string_view call, std::string_view path) {
  const std::string_view wanted = state()->call.data();
  const std::string_view folder = state()->folder.data();
  if (folder.empty() || (wanted != call && wanted != "any") || !path.starts_with(folder)) {
    return false;
  }
  return path.size() == folder.size() || path[folder.size()] == '/';
}

bool is_writable(int descriptor) {
  const int flags = ::fcntl(descriptor, F_GETFL);
  return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
}

bool has_error(std::string_view name) {
  return std::string_view(state()->error.data()) == name;
}

/// Counts a call; whether it is the one that fails.
bool is_hit(std::string_view call, const std::string& path) {
  if (!is_counted(call, path)) return false;
  State& s = *state();
  const std::uint64_t number = ++s.calls;
  if (s.at == 0 || number < s.at || (number > s.at && !has_error("ENOSPC"))) return false;
  if (s.hits++ == 0) std::snprintf(s.path.data(), s.path.size(), "%s", path.c_str());
  return true;
}

/// Fails, or ends the process group.
int fail() {
  if (has_error("kill")) {
    ::kill(0, SIGKILL);
    for (;;) ::pause();  // until the signal is delivered
  }
  errno = has_error("ENOSPC") ? ENOSPC : EIO;
  return -1;
}

/// The errno of the caller stays as it was where nothing fails.
class KeepErrno {
 public:
  KeepErrno() = default;
  KeepErrno(const KeepErrno&) = delete;
  KeepErrno& operator=(const KeepErrno&) = delete;
  ~KeepErrno() { errno = saved_; }

 private:
  int saved_ = errno;
};

bool fails(std::string_view call, int descriptor) {
  const KeepErrno keep;
  if (state() == nullptr || (call != "sync" && !is_writable(descriptor))) return false;
  return is_hit(call, path_of(descriptor));
}

bool fails(std::string_view call, int folder, const char* name) {
  const KeepErrno keep;
  return state() != nullptr && is_hit(call, path_of(folder, name));
}

bool opens_for_writing(int flags) {
  return (flags & O_ACCMODE) != O_RDONLY || (flags & O_CREAT) != 0;
}

using OpenAt = int (*)(int, const char*, int, ...);

int open_at(int folder, const char* path, int flags, mode_t mode) {
  static const auto real = next<OpenAt>("openat");
  if (opens_for_writing(flags) && fails("open", folder, path)) return fail();
  return real(folder, path, flags, mode);
}

mode_t mode_of(int flags, va_list arguments) {
  const bool has_mode = (flags & (O_CREAT | O_TMPFILE)) != 0;
  return has_mode ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_at(AT_FDCWD, path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_at(AT_FDCWD, path, flags | O_LARGEFILE, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_at(folder, path, flags, mode);
}

int openat64(int folder, const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_at(folder, path, flags | O_LARGEFILE, mode);
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  if (!fails("write", descriptor)) return real(descriptor, bytes, count);
  real(descriptor, bytes, count / 2);  // part of it may be on the disk all the same
  return fail();
}

ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t offset) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite");
  return fails("write", descriptor) ? fail() : real(descriptor, bytes, count, offset);
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t count, off64_t offset) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64");
  return fails("write", descriptor) ? fail() : real(descriptor, bytes, count, offset);
}

ssize_t writev(int descriptor, const iovec* pieces, int count) {
  static const auto real = next<ssize_t (*)(int, const iovec*, int)>("writev");
  return fails("write", descriptor) ? fail() : real(descriptor, pieces, count);
}

// While calls are counted, syncs are skipped, so that tests do not wait for the disk.
int fsync(int descriptor) {
  static const auto real = next<int (*)(int)>("fsync");
  if (fails("sync", descriptor)) return fail();
  return state() != nullptr ? 0 : real(descriptor);
}

int fdatasync(int descriptor) {
  static const auto real = next<int (*)(int)>("fdatasync");
  if (fails("sync", descriptor)) return fail();
  return state() != nullptr ? 0 : real(descriptor);
}

int rename(const char* from, const char* to) noexcept {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  return fails("rename", AT_FDCWD, to) ? fail() : real(from, to);
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  static const auto real = next<int (*)(int, const char*, int, const char*)>("renameat");
  return fails("rename", to_folder, to) ? fail() : real(from_folder, from, to_folder, to);
}

int close(int descriptor) {
  static const auto real = next<int (*)(int)>("close");
  if (!fails("close", descriptor)) return real(descriptor);
  real(descriptor);  // as on Linux, where it is closed even so
  return fail();
}

}  // extern "C"
