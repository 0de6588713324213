// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/prepared_scene.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace glidar::app {

/// A file that takes all frames of a run, such as a bag.
class RecordingOutput {
 public:
  RecordingOutput() = default;
  RecordingOutput(const RecordingOutput&) = delete;
  RecordingOutput& operator=(const RecordingOutput&) = delete;
  virtual ~RecordingOutput() = default;

  /// The cloud columns that it reads of a sensor's frames.
  [[nodiscard]] virtual std::vector<std::string> columns(const ActiveSensor& active) const = 0;
  /// Appends a frame. Throws Error.
  virtual void write(const ActiveSensor& active, const Frame& frame, const Beams& beams) = 0;
  /// Completes the file, which appears under its name. Without it nothing remains.
  virtual void finish() = 0;
  /// The files that finish() makes.
  [[nodiscard]] virtual std::vector<std::filesystem::path> files() const = 0;
};

/// Creates the recordings of the flags, which must outlive them like the scene. Throws Error when
/// a name is given twice or is that of an input, or when a recording does not fit the sensors.
std::vector<std::unique_ptr<RecordingOutput>> make_recordings(const RenderFlags& flags,
                                                              const PreparedScene& prepared);

}  // namespace glidar::app
