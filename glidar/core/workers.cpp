// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/workers.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace glidar {

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
  arena_->tbb.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        piece(body, range.begin(), range.end());
                      });
  });
}

void Workers::run_once(const void* body, void (*call)(const void*)) {
  arena_->tbb.execute([&] { call(body); });
}

}  // namespace glidar
