// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/recorder.hpp>

#include <glidar/core/version.hpp>
#include <glidar/io/files/content_hash.hpp>
#include <glidar/io/formats/sidecar.hpp>

namespace glidar::app {

void Recorder::begin(const PreparedScene& prepared, const CommandRecord& command) {
  link::RecordingHead head{.version = version(), .command = command, .files = {}};
  for (const std::string& file : prepared.files) {
    const std::optional<Hash128> hash = hash_file(file);
    head.files.push_back({.path = file, .hash = hash ? hex(*hash) : ""});
  }
  writer_.begin(head);
}

link::RecordedFrame line_of(std::size_t sensor_index, const Frame& frame,
                            const lockstep::Moment* placed) {
  link::RecordedFrame line{.sensor = static_cast<std::uint32_t>(sensor_index),
                           .moment = placed != nullptr ? *placed : lockstep::Moment{},
                           .is_placed = placed != nullptr,
                           .frame_hash = frame_hash(frame)};
  line.moment.t_ns = frame.stamp_ns;
  line.moment.seed = frame.seed;
  line.moment.number = frame.number;
  return line;
}

}  // namespace glidar::app
