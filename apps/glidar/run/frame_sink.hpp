// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/measured_frame.hpp>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace glidar::app {

/// How often idle connections are served.
inline constexpr std::chrono::milliseconds kDefaultServeInterval{20};

/// A destination of all frames of a run, such as a bag or a viewer.
class FrameSink {
 public:
  FrameSink() = default;
  FrameSink(const FrameSink&) = delete;
  FrameSink& operator=(const FrameSink&) = delete;
  virtual ~FrameSink() = default;

  /// The ground truth that it reads of a sensor's frames.
  [[nodiscard]] virtual HitColumnMask hit_columns(std::size_t sensor_index) const = 0;
  /// Takes a frame, in the order of time. Throws Error.
  virtual void write(const MeasuredFrame& measured) = 0;
  /// Called often, also between frames.
  virtual void serve() {}
  /// How often serve() is to be called.
  [[nodiscard]] virtual std::chrono::milliseconds serve_interval() const {
    return kDefaultServeInterval;
  }
  /// Call after the last frame: completes files, which appear under their names. Without it nothing
  /// of them remains.
  virtual void finish() = 0;
  /// The files that finish() makes.
  [[nodiscard]] virtual std::vector<std::filesystem::path> files() const { return {}; }
  /// What the sink wrote, for the user, each name after a space; empty: nothing.
  [[nodiscard]] virtual std::string written_text() const {
    std::string text;
    for (const std::filesystem::path& file : files()) text += " " + file.string();
    return text;
  }
};

}  // namespace glidar::app
