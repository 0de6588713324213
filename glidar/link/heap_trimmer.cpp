// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/heap_trimmer.hpp>

#include <malloc.h>

namespace glidar::link {
namespace {

/// Less than this is used again soon.
constexpr std::size_t kWorthwhile_bytes = std::size_t{8} << 20U;

}  // namespace

void HeapTrimmer::check(Clock::time_point now) {
  if (checks_left_ == 0 || now - last_ < kPause) return;
  last_ = now;
  --checks_left_;
#ifdef __GLIBC__
  if (::mallinfo2().fordblks >= kWorthwhile_bytes) ::malloc_trim(0);
#endif
}

}  // namespace glidar::link
