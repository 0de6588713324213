// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/console.hpp>

#include <apps/glidar/run/printing.hpp>
#include <apps/glidar/run/progress_line.hpp>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace glidar::app {
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

Console::Console(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1 && !quiet) {}

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

void Console::begin(std::string_view task) {
  const std::lock_guard lock(mutex_);
  task_ = task;
  fraction_ = -1.0;
  work_started_ = task_started_ = Clock::now();
  if (listener_.progress) listener_.progress(task_, fraction_);
}

void Console::redraw() {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (now - work_started_ < kProgressDelay) return;
  const double elapsed_s = std::chrono::duration<double>(now - task_started_).count();
  // returns to the line's start and erases it
  draw("\r\033[K" +
       progress_line(printable_line(task_), fraction_, elapsed_s, terminal_columns() - 1));
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

ProgressScope::ProgressScope(Console& console, std::string_view task) : console_(console) {
  console_.begin(task);
  if (!console_.terminal_) return;
  ticker_ = std::thread([this] {
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, kRedraw, [this] { return done_; })) console_.redraw();
  });
}

ProgressScope::~ProgressScope() {
  if (!ticker_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  changed_.notify_one();
  ticker_.join();
  console_.end();
}

}  // namespace glidar::app
