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

/// Inputs that all writers of a cast share.
struct HitTarget {
  const CastRequest& request;
  const Resolver& resolver;
  const rays::BeamSearch& search;
  Hits& hits;
};

/// Writes the hits of beams. Several batches are in progress at a time: data that later steps need
/// are prefetched meanwhile.
class SectorWriter {
 public:
  explicit SectorWriter(const HitTarget& target) : target_(target) {}

  /// Hits and misses of all beams of a sector's rows. Deferred cells count as misses.
  void write_rows(const SectorTable& sector, const SectorBuffer& buffer,
                  const InstanceSlots& slots);

  /// Casts beams as rays and writes their hits over misses.
  void cast_rays(std::span<const std::size_t> beams);

 private:
  /// Up to kLanes beams of a row.
  struct RowRun {
    std::size_t first_beam;
    std::size_t first_cell;
    std::uint32_t count;
  };

  void write_run(const SectorTable& sector, const SectorBuffer& buffer, const InstanceSlots& slots,
                 const RowRun& run);
  void take_beams(const SectorTable& sector, const RowRun& run, HitBatch& batch) const;
  void find_cells(const float* numbers, const InstanceSlots& slots, HitBatch& batch);
  HitBatch& next() { return batches_[begun_++ % batches_.size()]; }
  void advance();
  void finish();
  void write(HitBatch& batch) const;

  HitTarget target_;
  std::uint32_t last_number_ = kNoSlotNumber;  ///< of the previous cell
  PrimitiveRef last_found_;
  std::array<HitBatch, 3> batches_;
  std::size_t begun_ = 0;
};

}  // namespace glidar::scan_raster
