// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/link/lockstep/messages.hpp>

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

namespace glidar::app {

/// A frame to be delivered.
struct MeasuredFrame {
  Frame frame;
  std::shared_ptr<const Beams> beams;
  std::uint64_t place = 0;                         ///< among its sensor's frames
  std::size_t mount = 0;                           ///< which of the session's sensors took it
  std::shared_ptr<const lockstep::Moment> placed;  ///< who placed it; nullptr: the command did
  std::string frame_hash;                          ///< what frame_hash() must be; empty: not known
  std::chrono::steady_clock::time_point due;       ///< when its pose was there
};

/// Hands frames to what delivers them in a thread of its own, so that the next one is measured
/// meanwhile. Never more than two frames are under way: who measures waits for who delivers.
class Delivery {
 public:
  /// `deliver` and, often while there is nothing to deliver, `idle` are called by that thread; so
  /// is `failed`, once, after one of them threw.
  Delivery(std::function<void(const MeasuredFrame&)> deliver, std::function<void()> idle,
           std::function<void()> failed);
  /// Delivers what was handed over.
  ~Delivery();
  Delivery(const Delivery&) = delete;
  Delivery& operator=(const Delivery&) = delete;

  /// The measured to fill next; waits until it was delivered. Throws what `deliver` threw.
  MeasuredFrame& next_slot();
  /// The measured that next_slot() gave is filled.
  void submit();
  /// Waits until all is delivered and ends the thread. Throws what `deliver` threw.
  void finish();

 private:
  void run();
  void join();
  void rethrow();

  std::function<void(const MeasuredFrame&)> deliver_;
  std::function<void()> idle_;
  std::function<void()> failed_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::array<MeasuredFrame, 2> slots_;
  std::uint64_t filled_ = 0;
  std::uint64_t delivered_ = 0;
  bool is_ending_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace glidar::app
