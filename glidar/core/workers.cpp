// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/workers.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace glidar {
namespace {

// oneTBB hands work over in code that the thread sanitizer cannot see. These tell it that what
// comes before a loop happens before its pieces, and they before what follows the loop.
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

struct Workers::Arena {
  tbb::task_arena tbb;
};

Workers::Workers(unsigned threads) : arena_(std::make_unique<Arena>()) {
  arena_->tbb.initialize(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads));
}

Workers::~Workers() = default;

unsigned Workers::threads() const {
  return static_cast<unsigned>(arena_->tbb.max_concurrency());
}

void Workers::run(std::size_t count, std::size_t grain, const void* body, Piece piece) {
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

void Workers::run_once(const void* body, void (*call)(const void*)) {
  before_loop();
  arena_->tbb.execute([&] {
    before_piece();
    call(body);
    after_piece();
  });
  after_loop();
}

}  // namespace glidar
