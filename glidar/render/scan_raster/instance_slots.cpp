// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/instance_slots.hpp>

#include <glidar/render/common/rounding.hpp>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace glidar::scan_raster {
namespace {

/// Coordinates and scales for which the kernels' products neither overflow nor underflow.
constexpr double kMaxReach = 0x1p34;
constexpr double kMaxSlotScale = 0x1p20;
/// Tolerance of a rotation, far below the kernels' rounding.
constexpr double kRotationTolerance = 0x1p-30;
/// Boxes in single precision: some 20 roundings of 2^-24.
constexpr double kBoxMargin = 0x1p-19;

double largest(const double (&values)[3]) {
  return std::max({std::abs(values[0]), std::abs(values[1]), std::abs(values[2])});
}

/// Bounds the coordinates of all vertices and of the sensor.
double size_of(const rays::MeshSphere& sphere, const Eigen::Vector3d& sensor) {
  return largest(sphere.centre) + sphere.radius + sensor.cwiseAbs().maxCoeff();
}

bool is_rotation(const Eigen::Matrix3d& m) {
  const Eigen::Matrix3d rest = m * m.transpose() - Eigen::Matrix3d::Identity();
  return rest.cwiseAbs().maxCoeff() <= kRotationTolerance && m.determinant() > 0.0;
}

bool is_within_bounds(const InstanceView& view, const rays::MeshSphere& sphere) {
  return is_rotation(view.object_from_sensor) && view.scale <= kMaxSlotScale &&
         view.scale >= 1.0 / kMaxSlotScale && size_of(sphere, view.sensor_in_object) <= kMaxReach;
}

/// From the sensor to the instance's sphere, metres; negative inside of it.
double distance_m(const InstanceView& view, const rays::MeshSphere& sphere) {
  const Eigen::Map<const Eigen::Vector3d> centre(sphere.centre);
  return view.scale * ((view.sensor_in_object - centre).norm() - sphere.radius);
}

}  // namespace

bool InstanceSlots::prepare(const rays::SceneTrees& trees, const Resolver& resolver) {
  trees_ = &trees;
  order_ = trees.instances();
  for (const std::uint32_t i : order_) {
    if (!is_within_bounds(resolver.view(i), trees.of_instance(i).sphere)) return false;
  }
  std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double a_m = distance_m(resolver.view(a), trees.of_instance(a).sphere);
    const double b_m = distance_m(resolver.view(b), trees.of_instance(b).sphere);
    return a_m != b_m ? a_m < b_m : a < b;
  });
  return assign_slot_numbers();
}

bool InstanceSlots::assign_slot_numbers() {
  std::uint64_t next = 0;
  starts_.clear();
  first_number_.clear();
  for (const std::uint32_t i : trees_->instances()) {
    first_number_.resize(i + 1, kNoSlotNumber);
    first_number_[i] = static_cast<std::uint32_t>(next);
    starts_.push_back(first_number_[i]);
    next += std::uint64_t{kBlockSize} * trees_->of_instance(i).blocks.size();
    if (next >= kNoSlotNumber) return false;
  }
  return true;
}

std::uint32_t InstanceSlots::instance_of(std::uint32_t number) const {
  if (starts_.size() == 1) return trees_->instances()[0];
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), number);
  return trees_->instances()[static_cast<std::size_t>(after - starts_.begin()) - 1];
}

PrimitiveRef InstanceSlots::decode(std::uint32_t number) const {
  if (number == kNoSlotNumber) return {};
  const std::uint32_t instance = instance_of(number);
  const std::uint32_t slot = number - first_number_[instance];
  const TriangleBlock& block = trees_->of_instance(instance).blocks[slot / kBlockSize];
  return {instance, block.primitive[slot % kBlockSize]};
}

Placement make_placement(const rays::SceneTrees& trees, const InstanceView& view,
                         std::uint32_t instance, const SectorTable& sector) {
  const rays::MeshTree& tree = trees.of_instance(instance);
  const Eigen::Matrix3d& rotation = view.object_from_sensor;
  const Eigen::Vector3d origin = view.sensor_in_object + rotation * sector.origin_m() / view.scale;
  const SectorFrame& frame = sector.frame();
  const Eigen::Matrix3f sector_from_object =
      (frame.sector_from_sensor * rotation.transpose()).cast<float>();
  const Eigen::Matrix3f slopes_from_object =
      (frame.slopes_from_sensor * rotation.transpose()).cast<float>();
  Placement p{};
  p.tree = tree.view();
  for (int axis = 0; axis < 3; ++axis) {
    p.origin[axis] = origin[axis];
    p.foot[axis] = next_above(sector.foot_m()[axis] / view.scale);
    for (int i = 0; i < 3; ++i) {
      p.sector_from_object[axis][i] = sector_from_object(axis, i);
      p.slopes_from_object[axis][i] = slopes_from_object(axis, i);
    }
  }
  p.behind = next_above(sector.behind_m() / view.scale);
  p.distance = next_above(sector.distance_m() / view.scale);
  p.metres = view.scale;
  // As in packet_start.hpp.
  p.rounding = origin.lpNorm<1>() + 2.0 * sector.distance_m() / view.scale +
               0x1p4 * trees.max_reach_m() / view.scale;
  p.margin = next_above(kBoxMargin * size_of(tree.sphere, origin));
  return p;
}

}  // namespace glidar::scan_raster
