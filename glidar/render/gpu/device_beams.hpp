// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/render/opengl/gl_object.hpp>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace glidar::gpu {

/// The beams of the last casts in the memory of the graphics device. Those of a sensor are mostly
/// the same in every frame, and comparing them is faster than transferring them.
class DeviceBeams {
 public:
  /// The buffer with the directions of these beams and then their origins, if they have any.
  /// Beams that hit nothing, because they have no direction or start beyond all limits, have the
  /// direction zero. Valid until the next call.
  const opengl::Buffer& upload(const Beams& beams);

  /// The size of that buffer.
  static std::size_t bytes(const Beams& beams);

 private:
  struct Entry {
    std::vector<Eigen::Vector3d> directions;
    std::vector<Eigen::Vector3d> origins_m;
    opengl::Buffer buffer;
  };

  static constexpr std::size_t kEntries = 4;
  std::array<Entry, kEntries> entries_;
  std::size_t oldest_ = 0;
  std::vector<Eigen::Vector3d> uploaded_;
};

}  // namespace glidar::gpu
