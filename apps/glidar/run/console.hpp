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
/// and the progress display from running into each other; every function may be called from any
/// thread.
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
  /// Says what went wrong, for programs that go on; nobody else is told.
  void error(std::string_view message);
  /// How far the work is that is under way (see ProgressScope), negative: unknown. Costs little.
  void set_progress(double fraction_done);
  /// The same of a part of that work that has a name of its own.
  void set_progress(std::string_view task, double fraction_done);

  /// A line that stands on a terminal until the next one, or anything else, takes its place; empty:
  /// none.
  void status(std::string_view line);

  /// The library's way to all of the above; must not outlive the console.
  Report report();
  /// Who else is told all that; called from the threads that tell it. Empty: nobody.
  void listen(Report listener);

 private:
  friend class ProgressScope;
  using Clock = std::chrono::steady_clock;

  void begin(std::string_view task);
  void redraw();
  void end();
  void erase();

  std::mutex mutex_;
  Report listener_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  std::string task_;
  double fraction_ = -1.0;
  Clock::time_point work_started_;
  Clock::time_point task_started_;
};

/// While it lives, the console shows how far this work is: on a terminal only, and only once it has
/// taken two seconds. One at a time.
class ProgressScope {
 public:
  ProgressScope(Console& console, std::string_view task);
  ProgressScope(const ProgressScope&) = delete;
  ProgressScope& operator=(const ProgressScope&) = delete;
  ~ProgressScope();

 private:
  Console& console_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
  std::thread ticker_;
};

}  // namespace glidar::app
