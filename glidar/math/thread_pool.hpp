// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>

namespace glidar {

/// A fixed number of threads that execute loops in parallel. Results must not depend on how a loop
/// is divided, so every output belongs to one index.
class ThreadPool {
 public:
  /// 0: one thread per processor that the process may use. oneTBB limits the number to 256 or more.
  explicit ThreadPool(unsigned threads = 0);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  [[nodiscard]] unsigned threads() const;

  /// Calls body(begin, end) for disjoint ranges that cover [0, count), each of about `grain` or
  /// more indices.
  template <class Body>
  void parallel_for(std::size_t count, std::size_t grain, const Body& body) {
    run(count, grain, &body, [](const void* erased, std::size_t begin, std::size_t end) {
      (*static_cast<const Body*>(erased))(begin, end);
    });
  }

  /// Calls body() inside this arena, so that parallel loops of other libraries use its threads too.
  template <class Body>
  void execute(const Body& body) {
    run_once(&body, [](const void* erased) { (*static_cast<const Body*>(erased))(); });
  }

 private:
  using Piece = void (*)(const void* body, std::size_t begin, std::size_t end);
  void run(std::size_t count, std::size_t grain, const void* body, Piece piece);
  void run_once(const void* body, void (*call)(const void*));

  struct Arena;
  std::unique_ptr<Arena> arena_;
};

}  // namespace glidar
