// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/ray_packet.hpp>
#include <glidar/render/rays/ties.hpp>
#include <glidar/render/scan_raster/instance_slots.hpp>

#include <cstdint>
#include <vector>

namespace glidar::scan_raster {

/// What is kept for the decisions in a sector.
struct DecisionMemory {
  /// The rule's distance to a cell's nearest triangle, object units, as long as it has this number.
  struct Known {
    std::uint32_t number;
    double distance;
  };
  std::vector<Known> known;              ///< per cell
  std::vector<std::size_t> handed_over;  ///< beams for rays, see SectorDecision::hand_over()

  /// Forgets all, for a sector of so many cells.
  void clear(std::size_t cells) {
    known.assign(cells, {kNoNumber, 0.0});
    handed_over.clear();
  }
};

/// Applies the hit rule to cells and triangles that single precision leaves in doubt.
class SectorDecision {
 public:
  /// The memory is clear.
  SectorDecision(const rays::CastView& cast, const InstanceSlots& slots, const SectorTable& sector,
                 const SectorPicture& picture, DecisionMemory& memory)
      : cast_(cast), slots_(slots), sector_(sector), picture_(picture), memory_(memory) {}

  /// Takes the next instance, and completes its placement.
  void set_instance(std::uint32_t instance, Placement& placement);

 private:
  void decide(std::uint32_t cell, std::uint32_t slot);
  void trace(std::uint32_t cell, std::uint32_t slot);
  [[nodiscard]] bool is_first(std::uint32_t cell, const Found& found, double low_m, double high_m);
  /// Leaves a cell to rays, since some triangles tie: it counts as one without a beam, and its beam
  /// is added to those handed over.
  void hand_over(std::uint32_t cell);
  void keep_distance(std::uint32_t cell);
  [[nodiscard]] std::uint32_t number_at(std::uint32_t cell) const;

  rays::CastView cast_;
  const InstanceSlots& slots_;
  const SectorTable& sector_;
  SectorPicture picture_;
  DecisionMemory& memory_;
  std::uint32_t instance_ = 0;
  std::size_t beam_ = 0;
  rays::RayPacket packet_{};  ///< of which the first ray is used
};

}  // namespace glidar::scan_raster
