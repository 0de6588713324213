// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/measured_frame.hpp>

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace glidar::app {

/// Delivers frames in its own thread, while the next frame is measured. At most two frames are in
/// progress: measuring waits for delivery.
class Delivery {
 public:
  /// The thread calls `deliver`, `idle` (after each frame, and every `idle_interval` while there is
  /// nothing to deliver), and `failed` (once, after one of them threw).
  Delivery(std::function<void(const MeasuredFrame&)> deliver, std::function<void()> idle,
           std::function<void()> failed,
           std::chrono::milliseconds idle_interval = kDefaultServeInterval);
  /// Delivers the submitted frames.
  ~Delivery();
  Delivery(const Delivery&) = delete;
  Delivery& operator=(const Delivery&) = delete;

  /// The next free frame; waits for one. Throws what `deliver` threw.
  MeasuredFrame& next_slot();
  /// Submits the frame of next_slot() for delivery.
  void submit();
  /// Waits for all deliveries and ends the thread. Throws what `deliver` threw.
  void finish();

 private:
  void run();
  void join();
  void rethrow();

  std::function<void(const MeasuredFrame&)> deliver_;
  std::function<void()> idle_;
  std::function<void()> failed_;
  std::chrono::milliseconds idle_interval_;
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
