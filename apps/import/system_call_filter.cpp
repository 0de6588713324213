// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/system_call_filter.hpp>

#include <fcntl.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

namespace glidar::import {
namespace {

/// Calls that are harmless with any arguments: they read open files, query paths, or affect only
/// this process.
constexpr std::array kHarmless = {
    // open files
    SCMP_SYS(read), SCMP_SYS(pread64), SCMP_SYS(readv), SCMP_SYS(lseek), SCMP_SYS(close),
    SCMP_SYS(fstat), SCMP_SYS(getdents64), SCMP_SYS(fadvise64),
    // paths
    SCMP_SYS(newfstatat), SCMP_SYS(statx), SCMP_SYS(stat), SCMP_SYS(lstat), SCMP_SYS(readlink),
    SCMP_SYS(readlinkat), SCMP_SYS(getcwd), SCMP_SYS(access), SCMP_SYS(faccessat),
    SCMP_SYS(faccessat2),
    // memory
    SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise),
    // this process
    SCMP_SYS(futex), SCMP_SYS(rt_sigaction), SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn),
    SCMP_SYS(sigaltstack), SCMP_SYS(getpid), SCMP_SYS(gettid), SCMP_SYS(getuid), SCMP_SYS(geteuid),
    SCMP_SYS(getgid), SCMP_SYS(getegid), SCMP_SYS(getrlimit), SCMP_SYS(sched_yield),
    SCMP_SYS(sched_getaffinity), SCMP_SYS(restart_syscall), SCMP_SYS(rseq),
    SCMP_SYS(set_robust_list), SCMP_SYS(setitimer), SCMP_SYS(exit), SCMP_SYS(exit_group),
    // time, random numbers, the number of processors
    SCMP_SYS(clock_gettime), SCMP_SYS(clock_getres), SCMP_SYS(gettimeofday), SCMP_SYS(time),
    SCMP_SYS(getrandom), SCMP_SYS(sysinfo), SCMP_SYS(uname)};

/// The answer, the progress, and the standard streams, which are /dev/null.
constexpr int kLastWritable = 4;

class Filter {
 public:
  Filter() : context_(seccomp_init(SCMP_ACT_ERRNO(EPERM)), seccomp_release) {}

  /// Allows a call if its arguments fulfil all conditions.
  template <class... Condition>
  void allow(int call, Condition... conditions) {
    const std::array<scmp_arg_cmp, sizeof...(Condition)> all{conditions...};
    if (context_ == nullptr || error_ != 0) return;
    const int error = seccomp_rule_add_array(context_.get(), SCMP_ACT_ALLOW, call,
                                             static_cast<unsigned>(all.size()), all.data());
    // a call that this architecture does not have
    if (error != -EDOM) error_ = error;
  }

  std::string load() {
    if (context_ == nullptr) return "libseccomp cannot be used";
    // A binary tree rather than a chain of comparisons: fewer steps for each call.
    seccomp_attr_set(context_.get(), SCMP_FLTATR_CTL_OPTIMIZE, 2);
    seccomp_attr_set(context_.get(), SCMP_FLTATR_API_SYSRAWRC, 1);  // the system's own errors
    if (error_ == 0) error_ = seccomp_load(context_.get());
    return error_ == 0 ? "" : std::strerror(-error_);
  }

 private:
  std::unique_ptr<void, void (*)(scmp_filter_ctx)> context_;
  int error_ = 0;
};

scmp_arg_cmp without(unsigned argument, std::uint64_t bits) {
  return {argument, SCMP_CMP_MASKED_EQ, bits, 0};
}

scmp_arg_cmp equals(unsigned argument, std::uint64_t value) {
  return {argument, SCMP_CMP_EQ, value, 0};
}

void allow_files(Filter& filter, Openat2 openat2) {
  // O_TMPFILE without O_DIRECTORY, which is a part of it and harmless
  constexpr std::uint64_t kWriting =
      O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND | (O_TMPFILE & ~O_DIRECTORY);
  filter.allow(SCMP_SYS(openat), without(2, kWriting));
  filter.allow(SCMP_SYS(open), without(1, kWriting));
  if (openat2 == Openat2::allowed) filter.allow(SCMP_SYS(openat2));
  for (const int call : {SCMP_SYS(write), SCMP_SYS(pwrite64), SCMP_SYS(writev)}) {
    filter.allow(call, scmp_arg_cmp{0, SCMP_CMP_LE, kLastWritable, 0});
  }
  for (const int command : {F_GETFD, F_SETFD, F_GETFL}) {
    filter.allow(SCMP_SYS(fcntl), equals(1, static_cast<std::uint64_t>(command)));
  }
}

void allow_memory(Filter& filter) {
  filter.allow(SCMP_SYS(mmap), without(2, PROT_EXEC));
  filter.allow(SCMP_SYS(mprotect), without(2, PROT_EXEC));
}

void allow_own_end(Filter& filter) {
  const auto self = static_cast<std::uint64_t>(::getpid());
  filter.allow(SCMP_SYS(tgkill), equals(0, self));                // abort()
  filter.allow(SCMP_SYS(prlimit64), equals(0, 0), equals(2, 0));  // reads a limit
  // Sets its own limits, up to those that are fixed (process_limits.hpp).
  constexpr std::uint64_t kInt = 0xFFFF'FFFF;
  for (const std::uint64_t resource : {RLIMIT_DATA, RLIMIT_STACK}) {
    filter.allow(SCMP_SYS(prlimit64), equals(0, 0),
                 scmp_arg_cmp{1, SCMP_CMP_MASKED_EQ, kInt, resource});
  }
}

}  // namespace

std::string filter_system_calls(Openat2 openat2) {
  Filter filter;
  for (const int call : kHarmless) filter.allow(call);
  allow_files(filter, openat2);
  allow_memory(filter);
  allow_own_end(filter);
  return filter.load();
}

}  // namespace glidar::import
