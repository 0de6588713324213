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
  /// Adds to `handed_over`, see hand_over().
  SectorDecision(const rays::CastView& cast, const InstanceSlots& slots, const SectorTable& sector,
                 const SectorPicture& picture, std::vector<std::size_t>& handed_over)
      : cast_(cast), slots_(slots), sector_(sector), picture_(picture), handed_over_(handed_over) {}

  /// Takes the next instance, and completes its placement.
  void set_instance(std::uint32_t instance, Placement& placement);

 private:
  void decide(std::uint32_t cell, std::uint32_t slot);
  bool is_coincident(std::uint32_t cell, std::uint32_t slot);
  void trace(std::uint32_t cell, std::uint32_t slot);
  [[nodiscard]] bool is_first(std::uint32_t cell, const Found& found, double low_m, double high_m);
  /// Leaves a cell to rays, since some triangles tie: it counts as one without a beam, and its beam
  /// is added to those handed over.
  void hand_over(std::uint32_t cell);
  [[nodiscard]] std::uint32_t number_at(std::uint32_t cell) const;

  rays::CastView cast_;
  const InstanceSlots& slots_;
  const SectorTable& sector_;
  SectorPicture picture_;
  std::vector<std::size_t>& handed_over_;
  std::uint32_t instance_ = 0;
  std::size_t beam_ = 0;
  std::uint32_t compared_ = kNoNumber;  ///< number and slot that were compared last
  std::uint32_t compared_slot_ = 0;
  bool is_same_ = false;      ///< they have the same corners
  std::uint32_t lower_ = 0;   ///< then the one to keep
  rays::RayPacket packet_{};  ///< of which the first ray is used
};

}  // namespace glidar::scan_raster
