// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/report.hpp>
#include <glidar/core/text.hpp>

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdio>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <utility>

namespace glidar::app {

// Exit codes. An interrupt returns 130; `stream` returns 128 plus the signal's number.
inline constexpr int kDone = 0;
inline constexpr int kCheckFailed = 1;   ///< `verify` found errors beyond its bounds
inline constexpr int kBadInput = 2;      ///< options, files, values
inline constexpr int kClosedPipe = 141;  ///< standard output was closed, as shells report it
inline constexpr int kNoPoses = 3;       ///< `stream`: no pose within --pose-timeout

/// Prints lines for people. Nothing in them controls a terminal, see printable_lines().
void print_lines(std::FILE* to, std::string_view lines);

/// Prints a line to standard error: the prefix and the message, which is cut at 8 KiB, because it
/// may quote files of others.
void print_message(std::string_view prefix, std::string_view message);

/// A value of print(): texts become one printable line.
template <class Value>
decltype(auto) printable_value(const Value& value) {
  if constexpr (std::is_convertible_v<const Value&, std::string_view>) {
    return printable_line(value);
  } else {
    return (value);
  }
}

/// As fmt::format, for print().
template <class... Values>
std::string printable_format(fmt::string_view format, const Values&... values) {
  return fmt::vformat(format, fmt::make_format_args(values...));
}

/// As fmt::print, but line ends come from the format only, because texts may be from files.
template <class... Values>
void print(std::FILE* to, fmt::format_string<Values...> format, Values&&... values) {
  print_lines(to, printable_format(fmt::string_view(format), printable_value(values)...));
}

template <class... Values>
void print(fmt::format_string<Values...> format, Values&&... values) {
  app::print(stdout, format, std::forward<Values>(values)...);  // not fmt's
}

/// Prints JSON in ASCII; bytes that are no UTF-8 are replaced.
template <class Json>
void print_json(const Json& json) {
  print_lines(stdout, json.dump(2, ' ', true, Json::error_handler_t::replace) + "\n");
}

/// The progress display of a task: a bar with percent and the remaining time, or the elapsed time
/// if the fraction is unknown (negative). At most `columns` bytes.
std::string progress_line(std::string_view task, double fraction_done, double elapsed_s,
                          std::size_t columns);

/// The same as a line of text: "frame 12 of 200, 5 %, 3 min 10 s left".
std::string progress_text(std::string_view task, double fraction_done, double elapsed_s);

/// The terminal: results go to standard output, everything else to standard error. Keeps messages
/// and the progress display apart. Thread-safe.
class Console {
 public:
  using Clock = std::chrono::steady_clock;

  /// Without a terminal, progress is a line in each interval.
  explicit Console(bool quiet = false, Clock::duration line_interval = std::chrono::seconds(10));
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

  /// A counted task replaces those within it in the display.
  void begin(std::string_view task, std::size_t count);
  void next();
  void show();
  /// The task to show and the fraction that is done.
  [[nodiscard]] std::pair<std::string, double> shown();
  void redraw(double elapsed_s);
  void end();
  void erase();

  std::mutex mutex_;
  Report listener_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  std::string task_;
  double fraction_ = -1.0;
  std::string counted_;     ///< "frame" of "frame 12 of 200"
  std::size_t count_ = 0;   ///< of the counted task; 0: there is none
  std::size_t number_ = 0;  ///< of its current part, from 1
  double done_ = 0.0;  ///< the shown part of it, which grows although tasks within it begin at 0
  Clock::duration line_interval_;
  Clock::time_point last_line_;
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

/// RAII: shows the progress of this work on a terminal after two seconds, elsewhere in a line every
/// ten seconds. One at a time, and others within a counted one.
class ProgressScope {
 public:
  ProgressScope(Console& console, std::string_view task) : ProgressScope(console, task, 0) {}
  /// Work with several parts, each of which begins with next(): "frame 12 of 200" for the task
  /// "frame".
  ProgressScope(Console& console, std::string_view task, std::size_t count);
  ProgressScope(const ProgressScope&) = delete;
  ProgressScope& operator=(const ProgressScope&) = delete;
  ~ProgressScope();

  void next() { console_.next(); }

 private:
  Console& console_;
  bool is_counted_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
  std::thread ticker_;
};

}  // namespace glidar::app
