// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>
#include "embree_api.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace glidar::bench {

/// Rays to trace, each 16 of them as a packet.
struct RayList {
  struct Ray {
    Eigen::Vector3d origin;
    Eigen::Vector3d direction;
  };
  bool is_coherent = true;  ///< rays of a packet are similar
  std::vector<Ray> rays;
};

struct HitList {
  std::vector<float> range_m;
  std::vector<Eigen::Vector3f> normal;
  std::vector<std::uint32_t> instance;
  std::vector<std::uint32_t> primitive;

  void resize(std::size_t count);
};

/// Embree alone: robust, one mesh, packets of 16 or 8 or single rays, on this thread.
class RawRays {
 public:
  /// `isa`: Embree's name of an instruction set; empty: the best.
  RawRays(const Mesh& mesh, const RayList& list, unsigned packet_size, const std::string& isa);
  RawRays(const RawRays&) = delete;
  RawRays& operator=(const RawRays&) = delete;
  ~RawRays();

  void cast();

 private:
  void cast16(std::size_t first);
  void cast8(std::size_t first);
  void cast1(std::size_t index);

  const RayList& list_;
  unsigned packet_size_;
  RTCDevice device_;
  RTCScene scene_;
  HitList hits_;
};

}  // namespace glidar::bench
