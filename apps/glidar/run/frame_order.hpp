// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/prepared_scene.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace glidar::app {

/// A frame of one of the sensors.
struct SensorFrame {
  std::size_t sensor_index = 0;
  std::uint32_t number = 0;
};

/// The frames of all sensors in the order of their start; of frames that start together, in the
/// order of the sensors.
class FrameOrder {
 public:
  /// The sensors must outlive it. Each has ActiveSensor::frames frames.
  explicit FrameOrder(std::span<const ActiveSensor> sensors)
      : sensors_(sensors), numbers_(sensors.size()) {}
  /// Empty: there are no more frames.
  std::optional<SensorFrame> next();

 private:
  std::span<const ActiveSensor> sensors_;
  std::vector<std::uint32_t> numbers_;  ///< of each sensor's next frame
};

}  // namespace glidar::app
