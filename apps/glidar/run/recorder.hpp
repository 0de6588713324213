// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/session.hpp>
#include <glidar/link/recording.hpp>

#include <string>

namespace glidar::app {

/// `--record`: keeps what every frame of a stream depends on, and a hash of what came of it.
class Recorder {
 public:
  /// Throws Error when no file can be made there.
  Recorder(const std::string& path, bool is_durable)
      : writer_(path),
        durability_(is_durable ? link::Durability::synced : link::Durability::none) {}
  /// Once the session is open.
  void begin(const Session& session, const CommandRecord& command);
  void write(const link::RecordedFrame& frame) { writer_.write(frame); }
  void commit() { writer_.commit(durability_); }

 private:
  link::RecordingWriter writer_;
  link::Durability durability_;
};

/// The line of a frame by one of the session's sensors; `placed`: where a client or simulator put
/// everything, nullptr where the command did.
link::RecordedFrame line_of(std::size_t mount, const Frame& frame, const lockstep::Moment* placed);

}  // namespace glidar::app
