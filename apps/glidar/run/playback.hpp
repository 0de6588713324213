// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/interrupt.hpp>
#include <glidar/link/foxglove/messages.hpp>

#include <cstdint>
#include <mutex>

namespace glidar::app {

/// Whether the frames of a replay follow by themselves, as the user of the live view decides.
/// Begins paused at the first frame. Thread-safe.
class Playback {
 public:
  /// Of the page; from any thread.
  void command(foxglove::PlaybackCommand command);
  /// Waits until the next frame is due by these commands. False: a stop was requested before.
  bool wait(const StopRequest& stop);
  [[nodiscard]] bool is_playing() const;

 private:
  bool take_step();

  mutable std::mutex mutex_;
  bool is_playing_ = false;
  std::uint64_t steps_ = 1;  ///< frames that are due while it is paused
};

}  // namespace glidar::app
