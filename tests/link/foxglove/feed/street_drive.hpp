// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/scene.hpp>
#include <glidar/link/payload.hpp>
#include <glidar/simulate/simulator.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar::testing {

/// A car that drives through examples/street.yaml with a LiDAR and a depth camera.
class StreetDrive {
 public:
  /// Simulates so many frames of the sensor, a preset.
  StreetDrive(const std::string& sensor, int frames);

  [[nodiscard]] int frames() const { return static_cast<int>(points_.size()); }
  /// The messages of a frame with a stamp. Points have 34 bytes.
  [[nodiscard]] link::Payload cloud(int frame, std::uint64_t stamp_ns) const;
  [[nodiscard]] link::Payload depth_image(int frame, std::uint64_t stamp_ns) const;
  [[nodiscard]] link::Payload transform(int frame, std::uint64_t stamp_ns) const;
  [[nodiscard]] link::Payload odometry(int frame, std::uint64_t stamp_ns) const;
  /// Poses of LiDAR and camera on the car.
  [[nodiscard]] static link::Payload static_transforms();
  /// The trace of a point.
  [[nodiscard]] std::string explain(int frame, std::size_t point);

 private:
  [[nodiscard]] Pose world_from_car(int frame) const;
  [[nodiscard]] Motion motion(int frame, const Pose& car_from_sensor) const;
  void simulate_cloud(int frame);
  void simulate_depth(Simulator& camera, int frame);

  Scene scene_;
  Simulator lidar_;
  std::vector<std::string> points_;                ///< bytes of each frame
  std::vector<std::vector<std::size_t>> entries_;  ///< entry of each point in its frame
  std::vector<std::string> depths_;                ///< pixels of each frame
};

}  // namespace glidar::testing
