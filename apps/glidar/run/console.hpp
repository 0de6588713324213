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
/// and the progress display apart. Thread-safe.
class Console {
 public:
  explicit Console(bool quiet = false);
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;
  ~Console();

  /// Prints a note unless --quiet is given.
  void info(std::string_view message);
  /// Prints a warning, also with --quiet.
  void warn(std::string_view message);
  /// Prints an error after which the program continues; the listener does not get it.
  void error(std::string_view message);
  /// Progress of the current work (see ProgressScope); negative: unknown. Cheap.
  void set_progress(double fraction_done);
  /// The same for a named part of that work.
  void set_progress(std::string_view task, double fraction_done);

  /// A status line on a terminal, until the next output; empty: none.
  void status(std::string_view line);

  /// Callbacks for the library to all of the above; must not outlive the console.
  Report report();
  /// Also sends notes, warnings and progress to this listener, from any thread. Empty: none.
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

/// RAII: discards what libraries of the system (drivers, windows) print on standard error
/// meanwhile, unless a variable of theirs requests it: EGL_LOG_LEVEL, LIBGL_DEBUG, WAYLAND_DEBUG.
/// One at a time.
class SilencedLibraries {
 public:
  SilencedLibraries();
  SilencedLibraries(const SilencedLibraries&) = delete;
  SilencedLibraries& operator=(const SilencedLibraries&) = delete;
  ~SilencedLibraries();

 private:
  int stderr_ = -1;  ///< a copy of its descriptor; negative: not silenced
};

/// RAII: shows the progress of this work on a terminal after two seconds. One at a time.
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
