// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/beam_poses.hpp>

#include <limits>

namespace glidar {

void record_beam_poses(const Motion& motion, const Beams& beams, bool wanted,
                       ThreadPool& thread_pool, Frame& frame) {
  constexpr std::size_t kBeamsPerTask = 1024;
  Frame::BeamPoses& poses = frame.beam_poses;
  poses.world_from_sensor.resize(wanted ? beams.size() : 0);
  poses.world_from_object.resize(wanted ? beams.size() : 0);
  if (!wanted) return;
  const auto place_beam = [&](std::size_t i) {
    const std::int64_t t_ns = frame.stamp_ns + (beams.times_ns.empty() ? 0 : beams.times_ns[i]);
    const std::uint32_t instance = frame.ground_truth.instance[i];
    poses.world_from_sensor[i] = to_xyz_wxyz(pose_at(motion.world_from_sensor, t_ns));
    if (instance == kInvalidId) {
      poses.world_from_object[i].setConstant(std::numeric_limits<double>::quiet_NaN());
    } else {
      poses.world_from_object[i] = to_xyz_wxyz(pose_at(motion.world_from_instance[instance], t_ns));
    }
  };
  thread_pool.parallel_for(beams.size(), kBeamsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) place_beam(i);
  });
}

}  // namespace glidar
