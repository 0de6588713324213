// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/ray_packet.hpp>
#include <glidar/render/rays/ties.hpp>
#include <glidar/render/scan_raster/instance_slots.hpp>

#include <cstdint>
#include <vector>

namespace glidar::scan_raster {

/// Applies the hit rule to cells and triangles that single precision cannot decide.
class SectorExactTest {
 public:
  /// Adds to `deferred_beams`, see defer_to_rays().
  SectorExactTest(const rays::CastView& cast, const InstanceSlots& slots, const SectorTable& sector,
                  const SectorBuffer& buffer, std::vector<std::size_t>& deferred_beams)
      : cast_(cast),
        slots_(slots),
        sector_(sector),
        buffer_(buffer),
        deferred_beams_(deferred_beams) {}

  /// Sets the next instance, and completes its placement.
  void set_instance(std::uint32_t instance, Placement& placement);

 private:
  void retest_exactly(std::uint32_t cell, std::uint32_t slot);
  bool is_coincident(std::uint32_t cell, std::uint32_t slot);
  void trace(std::uint32_t cell, std::uint32_t slot);
  [[nodiscard]] bool is_first(std::uint32_t cell, const PrimitiveRef& found, double low_m,
                              double high_m);
  /// Defers a cell to rays, since some triangles tie: it then counts as one without a beam, and its
  /// beam is added to deferred_beams.
  void defer_to_rays(std::uint32_t cell);
  [[nodiscard]] std::uint32_t number_at(std::uint32_t cell) const;

  rays::CastView cast_;
  const InstanceSlots& slots_;
  const SectorTable& sector_;
  SectorBuffer buffer_;
  std::vector<std::size_t>& deferred_beams_;
  std::uint32_t instance_ = 0;
  std::size_t beam_ = 0;
  std::uint32_t compared_ = kNoSlotNumber;  ///< number and slot of the last comparison
  std::uint32_t compared_slot_ = 0;
  bool is_same_ = false;      ///< they have the same corners
  std::uint32_t lower_ = 0;   ///< if so, the number to keep
  rays::RayPacket packet_{};  ///< only the first ray is used
};

}  // namespace glidar::scan_raster
