// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/lockstep.hpp>
#include <glidar/output/output.hpp>

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace glidar::app {

/// A frame to be delivered.
struct MeasuredFrame {
  Frame frame;
  std::shared_ptr<const Beams> beams;
  std::uint64_t index = 0;                         ///< among its sensor's frames
  std::size_t sensor_index = 0;                    ///< of its sensor among those of the scene
  std::shared_ptr<const Motion> motion;            ///< with which it was measured
  std::shared_ptr<const lockstep::Moment> placed;  ///< poses by a client; nullptr: by the command
  std::string frame_hash;                          ///< expected frame_hash(); empty: unknown
  std::chrono::steady_clock::time_point due;       ///< when its pose was known

  /// The same for outputs.
  [[nodiscard]] RigFrame view() const { return {frame, *beams, sensor_index, index, due, motion}; }
};

/// Delivers frames in its own thread, while the next frame is measured. At most two frames are in
/// progress: measuring waits for delivery.
class Delivery {
 public:
  /// The thread calls `deliver`, `idle` (after each frame, and every `idle_interval` while there is
  /// nothing to deliver), and `failed` (once, after one of them threw).
  Delivery(std::function<void(const MeasuredFrame&)> deliver, std::function<void()> idle,
           std::function<void()> failed,
           std::chrono::milliseconds idle_interval = Output::kServeInterval);
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
