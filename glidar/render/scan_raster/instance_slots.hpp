// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/primitive_ref.hpp>
#include <glidar/render/rays/scene_trees.hpp>
#include <glidar/render/scan_raster/sector_table.hpp>

#include <cstdint>
#include <vector>

namespace glidar::scan_raster {

/// The instances of a cast in drawing order, and consecutive numbers for the slots of all their
/// triangles.
class InstanceSlots {
 public:
  /// Sets the enabled instances; the resolver and the trees have the poses of the cast. False when
  /// single precision has no error bounds for some instance: then the cast must use rays.
  bool prepare(const rays::SceneTrees& trees, const Resolver& resolver);

  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }
  [[nodiscard]] std::uint32_t first_number(std::uint32_t instance) const {
    return first_number_[instance];
  }

  /// The instance of a number.
  [[nodiscard]] std::uint32_t instance_of(std::uint32_t number) const;
  /// The triangle of a number; kNoSlotNumber: none.
  [[nodiscard]] PrimitiveRef decode(std::uint32_t number) const;

 private:
  bool assign_slot_numbers();

  const rays::SceneTrees* trees_ = nullptr;
  std::vector<std::uint32_t> order_;         ///< approximately nearest first
  std::vector<std::uint32_t> first_number_;  ///< per instance of the scene
  std::vector<std::uint32_t> starts_;        ///< first numbers of trees_->instances(), rising
};

/// An instance in the frame of a sector, without the callback for exact tests.
Placement make_placement(const rays::SceneTrees& trees, const InstanceView& view,
                         std::uint32_t instance, const SectorTable& sector);

}  // namespace glidar::scan_raster
