// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/console.hpp>

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace glidar::app {
namespace {

constexpr auto kPatience = std::chrono::seconds(2);
constexpr auto kRedraw = std::chrono::milliseconds(100);
constexpr int kBarWidth = 30;

void print(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

Console::Console(bool quiet)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1 && !quiet), started_(Clock::now()) {}

Console::~Console() {
  clear();
}

void Console::info(std::string_view message) {
  const std::lock_guard lock(mutex_);
  if (quiet_) return;
  erase();
  print(fmt::format("glidar: {}\n", message));
}

void Console::warn(std::string_view message) {
  const std::lock_guard lock(mutex_);
  erase();
  print(fmt::format("glidar: warning: {}\n", message));
}

void Console::progress(std::string_view task, double fraction_done) {
  const std::lock_guard lock(mutex_);
  if (!due(task)) return;
  const double fraction = std::clamp(fraction_done, 0.0, 1.0);
  if (fraction == 1.0) {
    erase();
    return;
  }
  const auto filled = static_cast<int>(fraction * kBarWidth);
  draw(fmt::format("{} [{:#<{}}{:.<{}}] {:3.0f} %", task, "", filled, "", kBarWidth - filled,
                   100.0 * fraction));
}

void Console::working(std::string_view task) {
  const std::lock_guard lock(mutex_);
  if (!due(task)) return;
  draw(fmt::format("{} ... {:.0f} s", task,
                   std::chrono::duration<double>(Clock::now() - started_).count()));
}

void Console::clear() {
  const std::lock_guard lock(mutex_);
  erase();
  task_.clear();
}

Report Console::report() {
  return {.log =
              [this](Severity severity, std::string_view message) {
                severity == Severity::warning ? warn(message) : info(message);
              },
          .progress = [this](std::string_view task,
                             double fraction_done) { progress(task, fraction_done); }};
}

/// True when this task has taken long enough for a line, and the last one is old enough.
bool Console::due(std::string_view task) {
  if (!terminal_) return false;
  const Clock::time_point now = Clock::now();
  if (task != task_) {
    erase();
    task_ = task;
    started_ = now;
  }
  return now - started_ >= kPatience && now - last_drawn_ >= kRedraw;
}

void Console::draw(const std::string& line) {
  print("\r\033[K" + line);  // back to the line's start, and empty it
  drawn_ = true;
  last_drawn_ = Clock::now();
}

void Console::erase() {
  if (drawn_) print("\r\033[K");
  drawn_ = false;
}

Working::Working(Console& console, std::string task) : console_(console), task_(std::move(task)) {
  ticker_ = std::thread([this] {
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, kRedraw, [this] { return done_; })) console_.working(task_);
  });
}

Working::~Working() {
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  changed_.notify_one();
  ticker_.join();
  console_.clear();
}

}  // namespace glidar::app
