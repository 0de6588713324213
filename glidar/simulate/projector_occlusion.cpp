// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/projector_occlusion.hpp>

#include <glidar/math/constants.hpp>

namespace glidar {
namespace {

constexpr std::size_t kHitsPerTask = 4096;

/// From a point to a beam's hit, in the sensor's frame.
Eigen::Vector3d path_to_hit(const Beams& fired, const Eigen::Vector3d& origin_m, const Hits& truth,
                            std::size_t i) {
  Eigen::Vector3d point = truth.range_m[i] * fired.directions[i];
  if (!fired.origins_m.empty()) point += fired.origins_m[i];
  return point - origin_m;
}

/// Beams from a point to the hits of the tested entries.
void point_at_hits(const Simulation& s, const Eigen::Vector3d& origin_m, EntryFilter is_tested,
                   Beams& beams) {
  const Beams& fired = *s.fired;
  const Hits& truth = s.frame.ground_truth;
  beams.rows = fired.rows;
  beams.cols = fired.cols;
  beams.boresight = fired.boresight;
  beams.times_ns = fired.times_ns;
  beams.origins_m.resize(fired.size());
  beams.directions.resize(fired.size());
  const auto point = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      beams.origins_m[i] = origin_m;
      beams.directions[i].setConstant(kNaN);
      if (truth.instance[i] == kInvalidId || !is_tested(i)) continue;
      const Eigen::Vector3d path = path_to_hit(fired, origin_m, truth, i);
      if (path.norm() > 0.0) beams.directions[i] = path.normalized();
    }
  };
  s.renderer.thread_pool().parallel_for(fired.size(), kHitsPerTask, point);
}

/// Whether a surface hides the hit from the point, or the point sees its other side.
bool is_hidden(const Simulation& s, const Eigen::Vector3d& origin_m, std::size_t i) {
  const Hits& truth = s.frame.ground_truth;
  const Eigen::Vector3d path = path_to_hit(*s.fired, origin_m, truth, i);
  const bool faces_away = truth.normal[i].cast<double>().dot(path) >= 0.0;
  return faces_away || s.workspace.sub_rays.hits.range_m[i] < (1.0 - kShadowEpsilon) * path.norm();
}

}  // namespace

void find_hidden(const Simulation& s, const Eigen::Vector3d& origin_m, EntryFilter is_tested,
                 std::vector<std::uint8_t>& hidden) {
  SubRayWorkspace& memory = s.workspace.sub_rays;
  const Hits& truth = s.frame.ground_truth;
  point_at_hits(s, origin_m, is_tested, memory.beams);
  cast(s, cast_request(s, memory.beams, {}), memory.hits);
  hidden.resize(s.fired->size());
  const auto test = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const bool is_surface = truth.instance[i] != kInvalidId && is_tested(i);
      hidden[i] = is_surface && is_hidden(s, origin_m, i) ? 1 : 0;
    }
  };
  s.renderer.thread_pool().parallel_for(s.fired->size(), kHitsPerTask, test);
}

void occlude_from_projector(const Simulation& s, const Eigen::Vector3d& projector_origin_m) {
  Frame& frame = s.frame;
  std::vector<std::uint8_t>& hidden = s.workspace.sub_rays.hidden;
  const auto has_return = [&](std::size_t i) { return frame.status[i] == Status::hit; };
  find_hidden(s, projector_origin_m, EntryFilter(has_return), hidden);
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    if (hidden[i] != 0) invalidate_return(frame, i, Status::occluded);
  }
}

}  // namespace glidar
