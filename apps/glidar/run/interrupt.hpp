// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <string>

namespace glidar::app {

/// From now on Ctrl-C (SIGINT), SIGTERM and a closed terminal (SIGHUP) remove unfinished output
/// files and end the program at once with exit code 130 (128 + SIGINT, as in shells). A limit on
/// the size of files becomes an error.
void end_cleanly_on_interrupt();

/// How a run ended by a signal: "interrupted by Ctrl-C (SIGINT)". 0: requested by the program.
std::string signal_text(int signal);

/// RAII: the first of these signals is only recorded, so that the program can shut down in order.
/// The second ends the program at once as above; so does SIGTERM unless disarm() is called within
/// 1.5 s. One at a time.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// The received signal; 0: none.
  [[nodiscard]] int signal() const;
  [[nodiscard]] bool is_requested() const { return signal() != 0 || is_requested_; }
  /// Requests a stop without a signal, from any thread.
  void request();
  /// Call when the shutdown has begun; it takes a limited time.
  void disarm() const;
  /// A file descriptor that is readable after a signal.
  [[nodiscard]] int descriptor() const { return reading_; }
  /// Waits for a signal, at most until then.
  void wait_until(std::chrono::steady_clock::time_point time) const;

 private:
  int reading_ = -1;
  int writing_ = -1;
  std::atomic<bool> is_requested_{false};
};

}  // namespace glidar::app
