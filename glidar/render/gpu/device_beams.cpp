// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/gpu/device_beams.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/render/gpu/device_scene.hpp>

#include <algorithm>
#include <cstring>
#include <span>

namespace glidar::gpu {
namespace {

bool are_same(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

bool can_hit(const Beams& beams, std::size_t beam) {
  const bool is_in_reach =
      beams.origins_m.empty() || beams.origins_m[beam].lpNorm<1>() <= kMaxCoordinate_m;
  return is_in_reach && beams.directions[beam].allFinite();
}

}  // namespace

std::size_t DeviceBeams::bytes(const Beams& beams) {
  return (beams.directions.size() + beams.origins_m.size()) * sizeof(Eigen::Vector3d);
}

const opengl::Buffer& DeviceBeams::upload(const Beams& beams) {
  for (const Entry& entry : entries_) {
    if (are_same(entry.directions, beams.directions) && are_same(entry.origins_m, beams.origins_m))
      return entry.buffer;
  }
  Entry& entry = entries_[oldest_];
  oldest_ = (oldest_ + 1) % kEntries;
  entry.directions = beams.directions;
  entry.origins_m = beams.origins_m;
  uploaded_.clear();
  for (std::size_t i = 0; i < beams.size(); ++i) {
    uploaded_.push_back(can_hit(beams, i) ? beams.directions[i] : Eigen::Vector3d::Zero());
  }
  uploaded_.insert(uploaded_.end(), beams.origins_m.begin(), beams.origins_m.end());
  fill<Eigen::Vector3d>(entry.buffer, uploaded_, GL_STATIC_DRAW);
  return entry.buffer;
}

}  // namespace glidar::gpu
