// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>

namespace glidar::app {

/// From now on Ctrl-C (SIGINT), SIGTERM and a closed terminal (SIGHUP) remove unfinished output
/// files and end the program at once with exit code 130 (128 + SIGINT, as shells have it); a limit
/// on the size of files is told as an error.
void end_cleanly_on_interrupt();

/// While it lives, the first of these signals is only noted, for work that has to be ended in good
/// order; the second ends the program at once as above, and so does SIGTERM itself unless its work
/// calls disarm() within 1.5 s. One at a time.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// The signal that came; 0: none.
  [[nodiscard]] int signal() const;
  [[nodiscard]] bool is_requested() const { return signal() != 0 || is_requested_; }
  /// The same without a signal, from any thread.
  void request();
  /// The work has begun to end in good order, which takes a limited time.
  void disarm() const;
  /// A file descriptor that can be read once one came.
  [[nodiscard]] int descriptor() const { return reading_; }
  /// Waits until one comes, at most until then.
  void wait_until(std::chrono::steady_clock::time_point time) const;

 private:
  int reading_ = -1;
  int writing_ = -1;
  std::atomic<bool> is_requested_{false};
};

}  // namespace glidar::app
