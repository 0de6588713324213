// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/motion.hpp>

namespace glidar {
namespace {

Pose evaluate(const ConstantPose& constant, std::int64_t /*t_ns*/) {
  return constant.pose;
}

}  // namespace

Pose pose_at(const Trajectory& trajectory, std::int64_t t_ns) {
  return std::visit([t_ns](const auto& kind) { return evaluate(kind, t_ns); }, trajectory);
}

Motion standing_still(const Scene& scene, const Pose& world_from_sensor) {
  Motion motion{.world_from_sensor = ConstantPose{world_from_sensor}, .world_from_instance = {}};
  motion.world_from_instance.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    motion.world_from_instance.emplace_back(ConstantPose{instance.world_from_object});
  }
  return motion;
}

void place(const Motion& motion, Frame& frame) {
  frame.world_from_sensor = pose_at(motion.world_from_sensor, frame.stamp_ns);
  frame.world_from_instance.resize(motion.world_from_instance.size());
  for (std::size_t i = 0; i < motion.world_from_instance.size(); ++i) {
    frame.world_from_instance[i] = pose_at(motion.world_from_instance[i], frame.stamp_ns);
  }
}

}  // namespace glidar
