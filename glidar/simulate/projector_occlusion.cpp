// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/projector_occlusion.hpp>

#include <glidar/math/constants.hpp>

namespace glidar {
namespace {

constexpr std::size_t kHitsPerTask = 4096;

/// From the projector to a beam's hit, in the sensor's frame.
Eigen::Vector3d from_projector(const Beams& fired, const Eigen::Vector3d& projector_origin_m,
                               const Hits& truth, std::size_t i) {
  Eigen::Vector3d point = truth.range_m[i] * fired.directions[i];
  if (!fired.origins_m.empty()) point += fired.origins_m[i];
  return point - projector_origin_m;
}

/// Beams from the projector to all hits.
void point_at_hits(const Beams& fired, const Eigen::Vector3d& projector_origin_m,
                   const Frame& frame, ThreadPool& thread_pool, Beams& beams) {
  beams.rows = fired.rows;
  beams.cols = fired.cols;
  beams.boresight = fired.boresight;
  beams.times_ns = fired.times_ns;
  beams.origins_m.resize(fired.size());
  beams.directions.resize(fired.size());
  thread_pool.parallel_for(fired.size(), kHitsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      beams.origins_m[i] = projector_origin_m;
      beams.directions[i].setConstant(kNaN);
      if (frame.status[i] != Status::hit || frame.ground_truth.instance[i] == kInvalidId) continue;
      const Eigen::Vector3d path = from_projector(fired, projector_origin_m, frame.ground_truth, i);
      if (path.norm() > 0.0) beams.directions[i] = path.normalized();
    }
  });
}

/// Whether a surface hides the hit from the projector, or the projector sees its other side.
bool is_occluded(const Simulation& s, const Eigen::Vector3d& projector_origin_m, std::size_t i) {
  constexpr double kEpsilon = 1e-6;  // relative: far above rounding, far below any shadow
  const Hits& truth = s.frame.ground_truth;
  const Eigen::Vector3d path = from_projector(*s.fired, projector_origin_m, truth, i);
  const bool faces_away = truth.normal[i].cast<double>().dot(path) >= 0.0;
  return faces_away || s.workspace.sub_rays.hits.range_m[i] < (1.0 - kEpsilon) * path.norm();
}

}  // namespace

void occlude_from_projector(const Simulation& s, const Eigen::Vector3d& projector_origin_m) {
  SubRayWorkspace& memory = s.workspace.sub_rays;
  ThreadPool& thread_pool = s.renderer.thread_pool();
  Frame& frame = s.frame;
  point_at_hits(*s.fired, projector_origin_m, frame, thread_pool, memory.beams);
  cast(s, cast_request(s, memory.beams, {}), memory.hits);
  thread_pool.parallel_for(s.fired->size(), kHitsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (frame.status[i] != Status::hit || frame.ground_truth.instance[i] == kInvalidId) continue;
      if (is_occluded(s, projector_origin_m, i)) invalidate_return(frame, i, Status::occluded);
    }
  });
}

}  // namespace glidar
