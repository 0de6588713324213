// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/thread_pool.hpp>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace glidar {
namespace {

// The thread sanitizer cannot see how oneTBB synchronises. These annotations state that code before
// a loop happens before its pieces, and the pieces before the code after the loop.
#if defined(__SANITIZE_THREAD__)
constexpr char kStart = 0;
constexpr char kEnd = 0;
void before_loop() {
  __tsan_release(const_cast<char*>(&kStart));
}
void before_piece() {
  __tsan_acquire(const_cast<char*>(&kStart));
}
void after_piece() {
  __tsan_release(const_cast<char*>(&kEnd));
}
void after_loop() {
  __tsan_acquire(const_cast<char*>(&kEnd));
}
#else
void before_loop() {}
void before_piece() {}
void after_piece() {}
void after_loop() {}
#endif

}  // namespace

struct ThreadPool::Arena {
  std::optional<tbb::global_control> limit;
  tbb::task_arena tbb;
};

/// oneTBB starts at most one thread per processor and writes a warning to standard error when an
/// arena requests more, unless a global_control allows more. The smallest global_control applies,
/// so all of GLIDAR's are equal, and a limit that the calling program sets is respected. oneTBB's
/// own limit is 256, or four per processor.
ThreadPool::ThreadPool(unsigned threads) : arena_(std::make_unique<Arena>()) {
  constexpr std::size_t kMaxThreads = 1024;
  constexpr auto kAllowed = tbb::global_control::max_allowed_parallelism;
  if (threads == 0) {
    arena_->tbb.initialize();
    return;
  }
  if (threads > static_cast<unsigned>(tbb::info::default_concurrency())) {
    arena_->limit.emplace(kAllowed, kMaxThreads);
  }
  const std::size_t allowed = tbb::global_control::active_value(kAllowed);
  arena_->tbb.initialize(static_cast<int>(std::min<std::size_t>(threads, allowed)));
}

ThreadPool::~ThreadPool() = default;

unsigned ThreadPool::threads() const {
  return static_cast<unsigned>(arena_->tbb.max_concurrency());
}

void ThreadPool::run(std::size_t count, std::size_t grain, const void* body, Piece piece) {
  before_loop();
  arena_->tbb.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        before_piece();
                        piece(body, range.begin(), range.end());
                        after_piece();
                      });
  });
  after_loop();
}

void ThreadPool::run_once(const void* body, void (*call)(const void*)) {
  before_loop();
  arena_->tbb.execute([&] {
    before_piece();
    call(body);
    after_piece();
  });
  after_loop();
}

}  // namespace glidar
