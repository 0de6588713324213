// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/thread_pool.hpp>
#include <glidar/render/resolver.hpp>

#include <cstdint>
#include <limits>
#include <vector>

namespace glidar {

/// Range of depths along the boresight; empty where nearest > farthest.
struct DepthSpan {
  double nearest_m = std::numeric_limits<double>::infinity();
  double farthest_m = -std::numeric_limits<double>::infinity();

  void extend(double depth_m) {
    nearest_m = depth_m < nearest_m ? depth_m : nearest_m;
    farthest_m = depth_m > farthest_m ? depth_m : farthest_m;
  }
  void extend(const DepthSpan& other) {
    nearest_m = other.nearest_m < nearest_m ? other.nearest_m : nearest_m;
    farthest_m = other.farthest_m > farthest_m ? other.farthest_m : farthest_m;
  }
};

/// Finds the depths of the part of a surface in a pinhole's view, occluded or not, exactly:
/// triangles are clipped at the borders of the view. Depth planes can therefore be tight also where
/// the nearest vertex is outside of the view or behind the sensor.
class VisibleDepths {
 public:
  DepthSpan of(const InstanceView& view, const Mesh& mesh, const PinholeIntrinsics& k,
               ThreadPool& thread_pool);

 private:
  std::vector<std::uint8_t> outside_;  ///< per vertex, a bit for every border beyond which it is
  std::vector<DepthSpan> spans_;       ///< per piece of the work
};

}  // namespace glidar
