// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/beam_search.hpp>
#include <glidar/render/scan_raster/instance_slots.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace glidar::scan_raster {

/// What the writers of a cast share.
struct HitTarget {
  const CastRequest& request;
  const Resolver& resolver;
  const rays::BeamSearch& search;
  Hits& hits;
};

/// Writes the hits of beams, some blocks at a time: what later steps read from memory comes while
/// other blocks are worked on.
class SectorWriter {
 public:
  explicit SectorWriter(const HitTarget& target) : target_(target) {}

  /// Hits and misses of all beams of a sector's rows. Cells handed over count as misses.
  void write_rows(const SectorTable& sector, const SectorPicture& picture,
                  const InstanceSlots& slots);

  /// Hits of beams, cast as rays, over misses.
  void cast_rays(std::span<const std::size_t> beams);

 private:
  struct Work {
    HitBlock block;
    BeamBlock beams;
    ExactBlock exact;
  };

  void take_beams(Work& work, std::size_t first, unsigned count) const;
  void find_cells(const float* numbers, const InstanceSlots& slots, Work& work) const;
  Work& next() { return ring_[begun_++ % ring_.size()]; }
  void pass_on();
  void finish();
  void write(Work& work) const;

  HitTarget target_;
  std::array<Work, 3> ring_;
  std::size_t begun_ = 0;
};

}  // namespace glidar::scan_raster
