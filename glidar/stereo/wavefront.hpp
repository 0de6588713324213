// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/thread_pool.hpp>

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace glidar::stereo {

/// Processes the chunks of rows in order: chunk c of a row after the chunks up to c + 1 of the row
/// before. Threads take rows in order, so the first row in work never waits for another thread.
class Wavefront {
 public:
  Wavefront(std::size_t rows, std::size_t chunks) : chunks_(chunks), done_(rows) {}

  /// Calls row_chunk(worker, row, chunk) for all, and finish(worker, row) after the last chunk of a
  /// row. Calls of one worker, a number below that of threads, never overlap. `pool` may be null.
  template <class RowChunk, class Finish>
  void run(ThreadPool* pool, const RowChunk& row_chunk, const Finish& finish) {
    std::atomic<std::size_t> workers{0};
    const auto work = [&](std::size_t, std::size_t) { take_rows(workers++, row_chunk, finish); };
    if (pool == nullptr || pool->threads() == 1) return work(0, 1);
    pool->parallel_for(pool->threads(), 1, work);
  }

 private:
  template <class RowChunk, class Finish>
  void take_rows(std::size_t worker, const RowChunk& row_chunk, const Finish& finish) {
    for (std::size_t row = next_++; row < done_.size(); row = next_++) {
      for (std::size_t chunk = 0; chunk < chunks_; ++chunk) {
        if (row > 0) wait_for(row - 1, chunk + 2 < chunks_ ? chunk + 2 : chunks_);
        row_chunk(worker, row, chunk);
        done_[row].store(chunk + 1, std::memory_order_release);
      }
      finish(worker, row);
    }
  }

  void wait_for(std::size_t row, std::size_t chunks) const {
    while (done_[row].load(std::memory_order_acquire) < chunks) std::this_thread::yield();
  }

  std::size_t chunks_;
  std::atomic<std::size_t> next_{0};
  std::vector<std::atomic<std::size_t>> done_;
};

}  // namespace glidar::stereo
