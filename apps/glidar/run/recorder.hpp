// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/prepared_scene.hpp>
#include <glidar/link/recording.hpp>

#include <string>

namespace glidar::app {

/// `--record`: keeps the inputs of every frame of a stream and a hash of its result.
class Recorder {
 public:
  /// Throws Error if the file cannot be created.
  Recorder(const std::string& path, bool is_durable)
      : writer_(path),
        durability_(is_durable ? link::Durability::synced : link::Durability::none) {}
  /// Call when the scene is prepared.
  void begin(const PreparedScene& prepared, const CommandRecord& command);
  void write(const link::RecordedFrame& frame) { writer_.write(frame); }
  void commit() { writer_.commit(durability_); }

 private:
  link::RecordingWriter writer_;
  link::Durability durability_;
};

/// The record of a frame of one sensor. `placed`: poses by a client or simulator;
/// nullptr: by the command.
link::RecordedFrame line_of(std::size_t sensor_index, const Frame& frame,
                            const lockstep::Moment* placed);

}  // namespace glidar::app
