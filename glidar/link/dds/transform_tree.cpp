// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/transform_tree.hpp>

#include <algorithm>
#include <utility>

namespace glidar::dds {

bool TransformTree::set(const FramedPose& pose, bool is_static) {
  const std::string& child = pose.frames.child;
  if (child == pose.frames.parent) return false;
  if (edges_.size() >= kMaxFrames && !edges_.contains(child)) return false;
  Edge edge{.parent = pose.frames.parent, .parent_from_child = Pose::Identity(), .t_ns = {}};
  edge.parent_from_child.linear() = pose.pose.orientation.toRotationMatrix();
  edge.parent_from_child.translation() = pose.pose.position_m;
  if (!is_static) edge.t_ns = pose.pose.t_ns;
  edges_.insert_or_assign(child, std::move(edge));
  return true;
}

std::vector<TransformTree::Step> TransformTree::way_to_root(const std::string& first) const {
  constexpr std::size_t kMaxDepth = 1000;  // published transforms may form a loop
  std::vector<Step> steps = {{.frame = first, .newest_ns = {}}};
  for (auto edge = edges_.find(first); edge != edges_.end() && steps.size() < kMaxDepth;
       edge = edges_.find(steps.back().frame)) {
    const auto& [parent, parent_from_child, t_ns] = edge->second;
    const Step& last = steps.back();
    steps.push_back({.frame = parent,
                     .frame_from_first = parent_from_child * last.frame_from_first,
                     .newest_ns = std::max(last.newest_ns, t_ns)});
  }
  return steps;
}

std::optional<TimedPose> TransformTree::find(const std::string& parent,
                                             const std::string& child) const {
  const std::vector<Step> from_child = way_to_root(child);
  const std::vector<Step> from_parent = way_to_root(parent);
  for (const Step& up : from_child) {
    const auto common = std::ranges::find(from_parent, up.frame, &Step::frame);
    if (common == from_parent.end()) continue;
    const Pose parent_from_child = common->frame_from_first.inverse() * up.frame_from_first;
    return TimedPose{.t_ns = std::max(up.newest_ns, common->newest_ns).value_or(0),
                     .position_m = parent_from_child.translation(),
                     .orientation = Eigen::Quaterniond(parent_from_child.linear()).normalized()};
  }
  return std::nullopt;
}

}  // namespace glidar::dds
