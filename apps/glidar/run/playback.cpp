// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/playback.hpp>

#include <chrono>

namespace glidar::app {
namespace {

/// How often a paused replay checks for a command.
constexpr std::chrono::milliseconds kCommandPollInterval{20};

}  // namespace

void Playback::command(foxglove::PlaybackCommand command) {
  const std::lock_guard lock(mutex_);
  is_playing_ = command == foxglove::PlaybackCommand::play;
  if (command == foxglove::PlaybackCommand::step) {
    ++steps_;
  } else {
    steps_ = 0;
  }
}

bool Playback::wait(const StopRequest& stop) {
  while (!stop.is_requested()) {
    if (take_step()) return true;
    stop.wait_until(std::chrono::steady_clock::now() + kCommandPollInterval);
  }
  return false;
}

bool Playback::take_step() {
  const std::lock_guard lock(mutex_);
  if (is_playing_) return true;
  if (steps_ == 0) return false;
  --steps_;
  return true;
}

bool Playback::is_playing() const {
  const std::lock_guard lock(mutex_);
  return is_playing_;
}

}  // namespace glidar::app
