// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/interrupt.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/atomic_file.hpp>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <ctime>
#include <string_view>

namespace glidar::app {
namespace {

// Only async-signal-safe calls are allowed here.
extern "C" void end_now(int number) {
  constexpr int kSignalExitBase = 128;  // as in shells
  constexpr std::string_view kMessage = "\nglidar: interrupted; unfinished files are removed\n";
  remove_unfinished_files();
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kMessage.data(), kMessage.size());
  _exit(kSignalExitBase + number);
}

// A signal handler takes no arguments, so these are global.
constinit std::atomic<int> noted{0};
constinit std::atomic<int> wake_pipe{-1};
constinit std::atomic<timer_t> deadline{};
constinit std::atomic<bool> has_deadline{false};
static_assert(std::atomic<int>::is_always_lock_free, "used in signal handlers");

/// Ends the process after this time, 0: never. Async-signal-safe.
void end_after(std::chrono::nanoseconds time) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time);
  const itimerspec once = {
      .it_interval = {},
      .it_value = {.tv_sec = seconds.count(), .tv_nsec = (time - seconds).count()}};
  if (has_deadline.load()) timer_settime(deadline.load(), 0, &once, nullptr);
}

extern "C" void end_late(int /*number*/) {
  end_now(noted.load());
}

extern "C" void note(int number) {
  constexpr std::chrono::milliseconds kStopTimeout{1500};
  if (noted.exchange(number) != 0) end_now(number);
  if (number == SIGTERM) end_after(kStopTimeout);
  [[maybe_unused]] const ssize_t written = write(wake_pipe.load(), "!", 1);
}

void handle_by(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // ignored under nohup
}

}  // namespace

void end_cleanly_on_interrupt() {
  handle_by(end_now);
  signal(SIGXFSZ, SIG_IGN);  // write() then returns an error
}

std::string signal_text(int signal) {
  switch (signal) {
    case 0:
      return "stopped by the program";
    case SIGINT:
      return "interrupted by Ctrl-C (SIGINT)";
    case SIGTERM:
      return "terminated (SIGTERM)";
    case SIGHUP:
      return "the terminal was closed (SIGHUP)";
    default:
      return "stopped by signal " + std::to_string(signal);
  }
}

StopRequest::StopRequest() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) {
    throw Error({.where = "signals", .found = "cannot create a pipe"});
  }
  reading_ = ends[0];
  writing_ = ends[1];
  noted = 0;
  wake_pipe = writing_;
  struct sigaction late {};
  late.sa_handler = end_late;
  sigaction(SIGALRM, &late, nullptr);
  timer_t timer{};
  has_deadline = timer_create(CLOCK_MONOTONIC, nullptr, &timer) == 0;  // sends SIGALRM
  deadline = timer;
  handle_by(note);
}

StopRequest::~StopRequest() {
  handle_by(end_now);
  if (has_deadline.exchange(false)) timer_delete(deadline.load());
  close(reading_);
  close(writing_);
}

int StopRequest::signal() const {
  return noted.load();
}

void StopRequest::disarm() const {
  end_after({});
}

void StopRequest::request() {
  is_requested_ = true;
  [[maybe_unused]] const ssize_t written = write(writing_, "!", 1);
}

void StopRequest::wait_until(std::chrono::steady_clock::time_point time) const {
  using std::chrono::nanoseconds;
  const auto left = std::max(nanoseconds(0), nanoseconds(time - std::chrono::steady_clock::now()));
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
  const timespec at_most = {.tv_sec = seconds.count(), .tv_nsec = (left - seconds).count()};
  pollfd pipe = {.fd = reading_, .events = POLLIN, .revents = 0};
  ppoll(&pipe, 1, &at_most, nullptr);
}

}  // namespace glidar::app
