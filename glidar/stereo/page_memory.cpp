// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/stereo/page_memory.hpp>

#include <sys/mman.h>

#include <new>
#include <utility>

namespace glidar::stereo {

namespace {

constexpr std::size_t kLargePage = std::size_t{1} << 21;

std::size_t byte_count(std::size_t elements) {
  const std::size_t bytes = elements * sizeof(std::int16_t);
  return (bytes + kLargePage - 1) / kLargePage * kLargePage;
}

}  // namespace

PageMemory::~PageMemory() {
  release();
}

PageMemory::PageMemory(PageMemory&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), count_(std::exchange(other.count_, 0)) {}

PageMemory& PageMemory::operator=(PageMemory&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(count_, other.count_);
  return *this;
}

void PageMemory::reserve(std::size_t count) {
  if (count <= count_) return;
  release();
  void* const memory = ::operator new (byte_count(count), std::align_val_t{kLargePage});
  // no harm where the system has no large pages
  (void)::madvise(memory, byte_count(count), MADV_HUGEPAGE);
  data_ = static_cast<std::int16_t*>(memory);
  count_ = count;
}

void PageMemory::release() noexcept {
  if (data_ != nullptr) ::operator delete (data_, std::align_val_t{kLargePage});
  data_ = nullptr;
  count_ = 0;
}

}  // namespace glidar::stereo
