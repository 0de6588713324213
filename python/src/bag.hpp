// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frame.hpp"

#include <glidar/io/bags/frame_bag.hpp>

#include <filesystem>
#include <memory>

namespace glidar::python {

/// Writes frames to a bag. The first frame determines the sensor.
class BagWriter {
 public:
  BagWriter(std::filesystem::path path, FrameBagOptions options);
  /// Throws Error when the frame is of another sensor. It needs the renderer if it lacks_boxes().
  void add(Measured& measured);
  void finish();

 private:
  std::filesystem::path path_;
  FrameBagOptions options_;
  // what the bag refers to
  std::shared_ptr<PreparedScene> prepared_;
  std::shared_ptr<const PreparedScene> unrendered_;
  std::shared_ptr<SensorHandle> sensor_;
  std::shared_ptr<const Beams> beams_;
  std::unique_ptr<FrameBag> bag_;
};

}  // namespace glidar::python
