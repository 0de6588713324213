// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/sensor.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

namespace glidar {

/// A sensor that does not change, with the beams of its first and its latest frame and those in
/// use.
class BeamCache {
 public:
  explicit BeamCache(Sensor sensor);
  /// The same with the beams of frame 0, where they are known.
  BeamCache(Sensor sensor, Beams first);

  [[nodiscard]] const Sensor& sensor() const { return sensor_; }
  /// The beams of a frame; all frames of a camera share theirs. May be called from any thread.
  [[nodiscard]] std::shared_ptr<const Beams> beams(std::uint32_t frame = 0) const;

 private:
  Sensor sensor_;
  std::shared_ptr<const Beams> first_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Beams> latest_;
  mutable std::map<std::uint32_t, std::weak_ptr<const Beams>> in_use_;  ///< by frame
};

}  // namespace glidar
