// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/process_limits.hpp>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>

namespace glidar::import {
namespace {

bool limit(__rlimit_resource resource, std::uint64_t value) {
  rlimit current{};
  if (::getrlimit(resource, &current) != 0) return false;
  // Keeps a stricter existing limit.
  const rlim_t most = value < current.rlim_max ? value : current.rlim_max;
  const rlimit wanted{most, most};
  return ::setrlimit(resource, &wanted) == 0;
}

// Importers recurse over the file's tree; the kernel keeps 128 MiB of addresses free for the stack.
constexpr std::uint64_t kStackBytes = std::uint64_t{100} << 20U;

// Sanitizers reserve terabytes of addresses and limit the resident memory themselves. Importers mix
// allocation functions and are in a library that is not instrumented.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitAddresses = false;
constexpr const char* kSanitizerOptions =
    "hard_rss_limit_mb=2048:allocator_may_return_null=1:alloc_dealloc_mismatch=0:"
    "detect_container_overflow=0";
extern "C" const char* __asan_default_options() {
  return kSanitizerOptions;
}
extern "C" const char* __tsan_default_options() {
  return "hard_rss_limit_mb=2048";
}
#else
constexpr bool kLimitAddresses = true;
#endif

}  // namespace

bool apply(const ProcessLimits& limits) {
  const auto seconds = static_cast<std::uint64_t>(std::ceil(limits.time_s)) + 1;
  const bool limited = limit(RLIMIT_CORE, 0) && limit(RLIMIT_STACK, kStackBytes) &&
                       limit(RLIMIT_CPU, seconds) && limit(RLIMIT_FSIZE, limits.memory_bytes) &&
                       (!kLimitAddresses || limit(RLIMIT_AS, limits.memory_bytes)) &&
                       (!kLimitAddresses || limit(RLIMIT_NPROC, 0));
  const bool bound =
      ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::prctl(PR_SET_PDEATHSIG, SIGKILL) == 0;
  // The parent may have died before the request for a signal.
  return limited && bound && ::getppid() == limits.parent;
}

}  // namespace glidar::import
