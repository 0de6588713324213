// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/process_limits.hpp>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <ctime>

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

namespace {

// A file of an empty model takes 20 MiB and 20 ms. Text formats and archives expand up to 200 times
// in memory; time is fifty times that of a slow format on a slow machine.
constexpr std::uint64_t kInputFloor_bytes = std::uint64_t{128} << 20U;
constexpr std::uint64_t kMemoryPerByte = 200;
constexpr std::uint64_t kInputStack_bytes = std::uint64_t{16} << 20U;
constexpr double kInputFloor_s = 1.5;
constexpr double kTimePerByte_s = 2e-6;

void set_soft_limit(__rlimit_resource resource, std::uint64_t value) {
  rlimit current{};
  if (!kLimitAddresses || ::getrlimit(resource, &current) != 0) return;
  current.rlim_cur = value < current.rlim_max ? value : current.rlim_max;
  ::setrlimit(resource, &current);
}

/// Of processor time; 0: never.
void set_alarm(double after_s) {
  const double whole_s = std::floor(after_s);
  const itimerval timer{
      {}, {static_cast<time_t>(whole_s), static_cast<suseconds_t>((after_s - whole_s) * 1e6)}};
  if (kLimitAddresses) ::setitimer(ITIMER_PROF, &timer, nullptr);
}

double processor_time_s() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

InputLimits::InputLimits() : start_s_(processor_time_s()) {
  set_soft_limit(RLIMIT_STACK, kInputStack_bytes);
  apply();
}

InputLimits::~InputLimits() {
  set_alarm(0.0);
  set_soft_limit(RLIMIT_DATA, RLIM_INFINITY);
  set_soft_limit(RLIMIT_STACK, RLIM_INFINITY);
}

void InputLimits::set_input(std::uint64_t bytes) {
  constexpr std::uint64_t kMax = std::uint64_t{1} << 40U;
  if (bytes <= input_bytes_) return;
  input_bytes_ = std::min(bytes, kMax);
  apply();
}

std::uint64_t InputLimits::memory_bytes() const {
  return kInputFloor_bytes + kMemoryPerByte * input_bytes_;
}

bool InputLimits::is_strictest() const {
  rlimit addresses{};
  return kLimitAddresses && ::getrlimit(RLIMIT_AS, &addresses) == 0 &&
         memory_bytes() < addresses.rlim_cur;
}

void InputLimits::apply() const {
  set_soft_limit(RLIMIT_DATA, memory_bytes());
  const double limit_s = kInputFloor_s + kTimePerByte_s * static_cast<double>(input_bytes_);
  set_alarm(std::max(limit_s - (processor_time_s() - start_s_), 1e-3));
}

}  // namespace glidar::import
