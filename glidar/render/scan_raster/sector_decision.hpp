// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/ray_packet.hpp>
#include <glidar/render/rays/ties.hpp>
#include <glidar/render/scan_raster/instance_slots.hpp>

#include <cstdint>
#include <vector>

namespace glidar::scan_raster {

/// Applies the hit rule to cells and triangles that single precision leaves in doubt.
class SectorDecision {
 public:
  SectorDecision(const rays::CastView& cast, const InstanceSlots& slots)
      : cast_(cast), slots_(slots) {}

  /// Takes the next sector, and forgets the cells handed over.
  void start(const SectorTable& sector, const SectorPicture& picture);
  /// Takes the next instance, and completes its placement.
  void set_instance(std::uint32_t instance, Placement& placement);

  /// Cells for which the nearest triangle is to be found by rays, since some tie: they count as
  /// cells without a beam.
  [[nodiscard]] const std::vector<std::uint32_t>& handed_over() const { return handed_over_; }

 private:
  void decide(std::uint32_t cell, std::uint32_t slot);
  void trace(std::uint32_t cell, std::uint32_t slot);
  [[nodiscard]] bool is_first(std::uint32_t cell, const Found& found, double low_m, double high_m);
  void hand_over(std::uint32_t cell);
  [[nodiscard]] std::uint32_t number_at(std::uint32_t cell) const;

  rays::CastView cast_;
  const InstanceSlots& slots_;
  const SectorTable* sector_ = nullptr;
  SectorPicture picture_{};
  std::uint32_t instance_ = 0;
  std::size_t beam_ = 0;
  rays::RayPacket packet_{};  ///< of which the first ray is used
  std::vector<std::uint32_t> handed_over_;
};

}  // namespace glidar::scan_raster
