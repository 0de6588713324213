// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/projector_occlusion.hpp>

#include <glidar/math/constants.hpp>

namespace glidar {
namespace {

constexpr std::size_t kHitsPerTask = 4096;

/// Where a beam's hit is, seen from the projector, in the sensor's frame.
Eigen::Vector3d from_projector(const Beams& aimed, const Eigen::Vector3d& projector_origin_m,
                               const Hits& truth, std::size_t i) {
  Eigen::Vector3d point = truth.range_m[i] * aimed.directions[i];
  if (!aimed.origins_m.empty()) point += aimed.origins_m[i];
  return point - projector_origin_m;
}

/// Beams from the projector to all hits.
void aim_at_hits(const Beams& aimed, const Eigen::Vector3d& projector_origin_m, const Frame& frame,
                 ThreadPool& thread_pool, Beams& beams) {
  beams.rows = aimed.rows;
  beams.cols = aimed.cols;
  beams.boresight = aimed.boresight;
  beams.times_ns = aimed.times_ns;
  beams.origins_m.resize(aimed.size());
  beams.directions.resize(aimed.size());
  thread_pool.parallel_for(aimed.size(), kHitsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      beams.origins_m[i] = projector_origin_m;
      beams.directions[i].setConstant(kNaN);
      if (frame.status[i] != Status::hit || frame.ground_truth.instance[i] == kInvalidId) continue;
      const Eigen::Vector3d way = from_projector(aimed, projector_origin_m, frame.ground_truth, i);
      if (way.norm() > 0.0) beams.directions[i] = way.normalized();
    }
  });
}

/// Whether something stands before the hit, or its other side is lit.
bool is_dark(const Beams& aimed, const Eigen::Vector3d& projector_origin_m, const Frame& frame,
             std::size_t i) {
  constexpr double kClear = 1e-6;  // of the way: far above rounding, far below any shadow
  const Eigen::Vector3d way = from_projector(aimed, projector_origin_m, frame.ground_truth, i);
  const bool faces_away = frame.ground_truth.normal[i].cast<double>().dot(way) >= 0.0;
  return faces_away || frame.workspace.sub_hits.range_m[i] < (1.0 - kClear) * way.norm();
}

}  // namespace

void occlude_from_projector(const Setup& setup, const Eigen::Vector3d& projector_origin_m,
                            const Beams& aimed, Frame& frame) {
  Workspace& memory = frame.workspace;
  aim_at_hits(aimed, projector_origin_m, frame, setup.renderer.thread_pool(), memory.sub_beams);
  cast_moving(timed_scene(setup, frame), request_of(setup, frame, memory.sub_beams, {}), memory,
              memory.sub_hits);
  setup.renderer.thread_pool().parallel_for(
      aimed.size(), kHitsPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          if (frame.status[i] != Status::hit || frame.ground_truth.instance[i] == kInvalidId)
            continue;
          if (is_dark(aimed, projector_origin_m, frame, i))
            invalidate_return(frame, i, Status::occluded);
        }
      });
}

}  // namespace glidar
