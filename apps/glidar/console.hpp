// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/report.hpp>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace glidar::app {

/// The terminal: results go to standard output, everything else to standard error. Keeps messages
/// and the progress bar from running into each other; every function may be called from any thread.
class Console {
 public:
  explicit Console(bool quiet = false);
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;
  ~Console();

  /// Says something useful that may be left out (--quiet).
  void info(std::string_view message);
  /// Says what the user should know; never left out.
  void warn(std::string_view message);
  /// Shows how far a task is. Appears only on a terminal, and only once the task has taken two
  /// seconds; goes away at `fraction_done` 1 or when another task starts.
  void progress(std::string_view task, double fraction_done);
  /// Shows how long a task has taken whose end is not known; same conditions.
  void working(std::string_view task);
  /// Takes the bar away.
  void clear();

  /// The library's way to all of the above; must not outlive the console.
  Report report();

 private:
  using Clock = std::chrono::steady_clock;

  bool due(std::string_view task);
  void draw(const std::string& line);
  void erase();

  std::mutex mutex_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  std::string task_;
  Clock::time_point started_;
  Clock::time_point last_drawn_;
};

/// While it lives, the console tells how long the task has been going.
class Working {
 public:
  Working(Console& console, std::string task);
  Working(const Working&) = delete;
  Working& operator=(const Working&) = delete;
  ~Working();

 private:
  Console& console_;
  std::string task_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
  std::thread ticker_;
};

}  // namespace glidar::app
