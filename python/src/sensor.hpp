// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bind.hpp"

#include <glidar/sensor/sensor.hpp>

#include <memory>
#include <mutex>

namespace glidar::python {

/// A Python sensor, which is immutable, and the beams of the most recently used frames.
class SensorHandle {
 public:
  explicit SensorHandle(Sensor sensor);

  [[nodiscard]] const Sensor& sensor() const { return sensor_; }
  /// Those of a frame; frames of cameras share theirs. May be called from any thread.
  [[nodiscard]] std::shared_ptr<const Beams> beams(std::uint32_t number) const;

 private:
  Sensor sensor_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Beams> first_;
  mutable std::shared_ptr<const Beams> last_;
  mutable std::uint32_t last_number_ = 0;
};

}  // namespace glidar::python
