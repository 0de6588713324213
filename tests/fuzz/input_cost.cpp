// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "input_cost.hpp"

#include "demand.hpp"

#include <atomic>
#include <cstdint>
#include <ctime>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define GLIDAR_COUNTS_MEMORY
#include <sanitizer/allocator_interface.h>
#endif
#endif

namespace glidar::testing {
namespace {

double processor_s() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Bytes that were allocated since the input began, now and at most.
std::atomic<std::int64_t> allocated = 0;
std::atomic<std::int64_t> max_allocated = 0;

#ifdef GLIDAR_COUNTS_MEMORY
void count_allocation(const volatile void* /*memory*/, std::size_t size) {
  const std::int64_t now = allocated += static_cast<std::int64_t>(size);
  if (now > max_allocated) max_allocated = now;
}

void count_release(const volatile void* memory) {
  if (memory == nullptr) return;
  allocated -=
      static_cast<std::int64_t>(__sanitizer_get_allocated_size(const_cast<const void*>(memory)));
}

const bool counts_memory =
    __sanitizer_install_malloc_and_free_hooks(count_allocation, count_release) != 0;
#endif

}  // namespace

InputCost::InputCost(std::size_t input_bytes) : input_bytes_(input_bytes), start_s_(processor_s()) {
#ifdef GLIDAR_COUNTS_MEMORY
  demand(counts_memory, "memory is counted");
#endif
  allocated = 0;
  max_allocated = 0;
}

InputCost::~InputCost() {
  constexpr double kFloor_s = 5.0;
  constexpr double kPerByte_s = 1e-3;
  constexpr std::int64_t kFloorBytes = std::int64_t{512} << 20U;
  constexpr std::int64_t kPerByte = 4096;
  demand(processor_s() - start_s_ < kFloor_s + kPerByte_s * static_cast<double>(input_bytes_),
         "the time for an input is in proportion to its size");
  demand(max_allocated < kFloorBytes + kPerByte * static_cast<std::int64_t>(input_bytes_),
         "the memory for an input is in proportion to its size");
}

}  // namespace glidar::testing
