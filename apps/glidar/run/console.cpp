// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/console.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace glidar::app {

void print_lines(std::FILE* to, std::string_view lines) {
  const std::string text = printable_lines(lines);
  std::fwrite(text.data(), 1, text.size(), to);
}

void print_message(std::string_view prefix, std::string_view message) {
  constexpr std::size_t kMaxMessage_bytes = 8192;
  print(stderr, "{}: {}\n", prefix, excerpt(message, kMaxMessage_bytes));
}

namespace {

std::string duration_text(double seconds) {
  constexpr double kLongest_s = 359'999.0;  // 99 h 59 min 59 s
  const auto s = static_cast<int>(std::ceil(std::min(seconds, kLongest_s)));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
}

/// The bar, percent and remaining time.
std::string bar_text(double fraction, double elapsed_s) {
  constexpr int kBarWidth = 30;
  const auto filled = static_cast<int>(fraction * kBarWidth);
  std::string text = fmt::format(" [{:#<{}}{:.<{}}] {:3.0f} %", "", filled, "", kBarWidth - filled,
                                 std::floor(100.0 * fraction));
  if (fraction > 0.0) {
    text += fmt::format(", {} left", duration_text(elapsed_s * (1.0 - fraction) / fraction));
  }
  return text;
}

}  // namespace

std::string progress_line(std::string_view task, double fraction_done, double elapsed_s,
                          std::size_t columns) {
  const std::string tail = fraction_done < 0.0
                               ? fmt::format(" ... {}", duration_text(std::floor(elapsed_s)))
                               : bar_text(std::min(fraction_done, 1.0), elapsed_s);
  const std::size_t room = columns > tail.size() ? columns - tail.size() : 0;  // for the name
  return (std::string(task.substr(0, room)) + tail).substr(0, columns);
}

std::string progress_text(std::string_view task, double fraction_done, double elapsed_s) {
  if (fraction_done < 0.0)
    return fmt::format("{}, {} so far", task, duration_text(std::floor(elapsed_s)));
  const double fraction = std::min(fraction_done, 1.0);
  std::string text = fmt::format("{}, {:.0f} %", task, std::floor(100.0 * fraction));
  if (fraction > 0.0)
    text += fmt::format(", {} left", duration_text(elapsed_s * (1.0 - fraction) / fraction));
  return text;
}

namespace {

constexpr auto kProgressDelay = std::chrono::seconds(2);
constexpr auto kRedraw = std::chrono::milliseconds(100);

/// Text for people is printable already; the rest controls the terminal.
void draw(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

/// Width of the terminal; a longer line would wrap and could not be erased.
std::size_t terminal_columns() {
  constexpr std::size_t kDefault = 80;
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return kDefault;
  return size.ws_col;
}

}  // namespace

Console::Console(bool quiet, Clock::duration line_interval)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1 && !quiet),
      line_interval_(line_interval) {}

Console::~Console() {
  end();
}

void Console::info(std::string_view message) {
  const std::lock_guard lock(mutex_);
  listener_.info(message);
  if (quiet_) return;
  erase();
  print_message("glidar", message);
}

void Console::warn(std::string_view message) {
  const std::lock_guard lock(mutex_);
  listener_.warn(message);
  erase();
  print_message("glidar: warning", message);
}

void Console::error(std::string_view message) {
  const std::lock_guard lock(mutex_);
  erase();
  print_message("glidar: error", message);
}

void Console::set_progress(double fraction_done) {
  const std::lock_guard lock(mutex_);
  fraction_ = fraction_done;
}

void Console::set_progress(std::string_view task, double fraction_done) {
  const std::lock_guard lock(mutex_);
  if (task != task_) {
    task_ = task;
    task_started_ = Clock::now();
  }
  fraction_ = fraction_done;
  if (listener_.progress) listener_.progress(task_, fraction_);
}

void Console::status(std::string_view line) {
  const std::lock_guard lock(mutex_);
  if (!terminal_) return;
  erase();
  if (line.empty()) return;
  draw(printable_line(line.substr(0, terminal_columns() - 1)));
  drawn_ = true;
}

void Console::listen(Report listener) {
  const std::lock_guard lock(mutex_);
  listener_ = std::move(listener);
}

Report Console::report() {
  return {.log =
              [this](Severity severity, std::string_view message) {
                severity == Severity::warning ? warn(message) : info(message);
              },
          .progress = [this](std::string_view task,
                             double fraction_done) { set_progress(task, fraction_done); }};
}

void Console::begin(std::string_view task, std::size_t count) {
  const std::lock_guard lock(mutex_);
  fraction_ = -1.0;
  task_ = task;
  task_started_ = Clock::now();
  if (count_ == 0) work_started_ = last_line_ = task_started_;
  if (count > 0) {
    counted_ = task;
    count_ = count;
    number_ = 0;
    done_ = 0.0;
  }
  if (listener_.progress) listener_.progress(task_, fraction_);
}

void Console::next() {
  const std::lock_guard lock(mutex_);
  ++number_;
  fraction_ = -1.0;
}

void Console::show() {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  const auto seconds_since = [now](Clock::time_point start) {
    return std::chrono::duration<double>(now - start).count();
  };
  if (terminal_ && now - work_started_ >= kProgressDelay)
    redraw(seconds_since(count_ > 0 ? work_started_ : task_started_));
  if (terminal_ || now - last_line_ < line_interval_) return;
  last_line_ = now;
  const auto [task, fraction] = shown();
  print(stderr, "glidar: {}\n",
        progress_text(task, fraction, seconds_since(count_ > 0 ? work_started_ : task_started_)));
}

std::pair<std::string, double> Console::shown() {
  if (count_ == 0) return {task_, fraction_};
  const std::size_t number = std::clamp<std::size_t>(number_, 1, count_);
  const double done = static_cast<double>(number - 1) + std::clamp(fraction_, 0.0, 1.0);
  done_ = std::max(done_, done / static_cast<double>(count_));
  return {fmt::format("{} {} of {}", counted_, number, count_), done_};
}

void Console::redraw(double elapsed_s) {
  const auto [task, fraction] = shown();
  // returns to the line's start and erases it
  draw("\r\033[K" +
       progress_line(printable_line(task), fraction, elapsed_s, terminal_columns() - 1));
  drawn_ = true;
}

void Console::end() {
  const std::lock_guard lock(mutex_);
  erase();
}

void Console::erase() {
  if (drawn_) draw("\r\033[K");
  drawn_ = false;
}

SilencedLibraries::SilencedLibraries() {
  for (const char* variable : {"EGL_LOG_LEVEL", "LIBGL_DEBUG", "WAYLAND_DEBUG"}) {
    if (std::getenv(variable) != nullptr) return;
  }
  const int discarded = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (discarded < 0) return;
  stderr_ = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  if (stderr_ >= 0) dup2(discarded, STDERR_FILENO);
  close(discarded);
}

SilencedLibraries::~SilencedLibraries() {
  if (stderr_ < 0) return;
  dup2(stderr_, STDERR_FILENO);
  close(stderr_);
}

ProgressScope::ProgressScope(Console& console, std::string_view task, std::size_t count)
    : console_(console), is_counted_(count > 0) {
  const bool is_within = console_.count_ > 0;
  console_.begin(task, count);
  if (console_.quiet_ || is_within) return;
  ticker_ = std::thread([this] {
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, kRedraw, [this] { return done_; })) console_.show();
  });
}

ProgressScope::~ProgressScope() {
  if (ticker_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    changed_.notify_one();
    ticker_.join();
    console_.end();
  }
  if (!is_counted_) return;
  const std::lock_guard lock(console_.mutex_);
  console_.count_ = 0;
}

}  // namespace glidar::app
