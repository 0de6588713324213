// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/sector_writer.hpp>

#include <algorithm>
#include <bit>
#include <cstring>

namespace glidar::scan_raster {

void SectorWriter::take_beams(const SectorTable& sector, const RowRun& run, HitBatch& batch) const {
  const Beams& beams = target_.request.beams;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    batch.block.beam[lane] = run.first_beam + std::min(lane, run.count - 1);
  }
  // Whole vectors are copied, since vectors written one number at a time are slow to load.
  Lanes3<double>& direction = batch.beams.direction;
  const auto take = [&](int axis, Lanes<double>& component) {
    std::memcpy(&component, sector.exact_direction(axis) + run.first_cell, sizeof(component));
  };
  take(0, direction.x);
  take(1, direction.y);
  take(2, direction.z);
  batch.beams.has_origins = !beams.origins_m.empty();
  if (!batch.beams.has_origins) return;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    batch.beams.origin_m.set(lane, beams.origins_m[batch.block.beam[lane]]);
  }
}

/// Sets the hits of the mask's lanes. Neighbours mostly have the same triangle.
void SectorWriter::find_cells(const float* numbers, const InstanceSlots& slots, HitBatch& batch) {
  HitBlock& block = batch.block;
  bool differs = false;
  for (std::uint32_t lanes = block.mask; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(lanes));
    const auto number = std::bit_cast<std::uint32_t>(numbers[lane]);
    const bool is_new = number != last_number_;
    if (is_new) {
      last_number_ = number;
      last_found_ = slots.decode(number);
    }
    block.instance[lane] = last_found_.instance;
    block.primitive[lane] = last_found_.primitive;
    if (is_new) target_.resolver.prefetch(block, lane);
    differs = differs || (is_new && lanes != block.mask);
  }
  block.is_one_triangle = !differs;
}

void SectorWriter::write_rows(const SectorTable& sector, const SectorBuffer& buffer,
                              const InstanceSlots& slots) {
  begun_ = 0;
  last_number_ = kNoSlotNumber;
  for (const SectorRow& row : sector.rows()) {
    for (std::uint32_t done = 0; done < row.count; done += kLanes) {
      write_run(sector, buffer, slots,
                {row.first_beam + done, row.first_cell + done,
                 std::min(row.count - done, std::uint32_t{kLanes})});
    }
  }
  finish();
}

void SectorWriter::write_run(const SectorTable& sector, const SectorBuffer& buffer,
                             const InstanceSlots& slots, const RowRun& run) {
  const float* numbers = buffer.number + run.first_cell;
  HitBatch& batch = next();
  batch.block.mask = 0;
  for (unsigned lane = 0; lane < run.count; ++lane) {
    const bool is_hit = std::bit_cast<std::uint32_t>(numbers[lane]) != kNoSlotNumber;
    batch.block.mask |= static_cast<std::uint32_t>(is_hit) << lane;
  }
  if (batch.block.mask != (1U << run.count) - 1U) {
    write_misses(target_.request.hit_columns, run.first_beam, run.count, target_.hits);
  }
  if (batch.block.mask != 0) {
    batch.block.is_run = batch.block.mask == (1U << kLanes) - 1U;
    take_beams(sector, run, batch);
    find_cells(numbers, slots, batch);
  }
  advance();
}

void SectorWriter::cast_rays(std::span<const std::size_t> beams_to_cast) {
  const Beams& beams = target_.request.beams;
  begun_ = 0;
  for (std::size_t done = 0; done < beams_to_cast.size(); done += kLanes) {
    const std::size_t count = std::min(beams_to_cast.size() - done, std::size_t{kLanes});
    HitBatch& batch = next();
    batch.block.is_one_triangle = false;
    batch.block.is_run = false;
    batch.beams.has_origins = !beams.origins_m.empty();
    for (unsigned lane = 0; lane < kLanes; ++lane) {
      const std::size_t beam = beams_to_cast[done + std::min<std::size_t>(lane, count - 1)];
      batch.block.beam[lane] = beam;
      batch.beams.direction.set(lane, beams.directions[beam]);
      if (batch.beams.has_origins) batch.beams.origin_m.set(lane, beams.origins_m[beam]);
    }
    batch.block.mask = (1U << count) - 1U;
    target_.search.find(batch.beams, batch.block);
    advance();
  }
  finish();
}

/// Advances the pipeline: prefetches for the batch before the last, and writes the oldest.
void SectorWriter::advance() {
  if (begun_ >= 2) {
    target_.resolver.prefetch_corners(batches_[(begun_ - 2) % batches_.size()].block,
                                      target_.request.hit_columns);
  }
  if (begun_ >= 3) write(batches_[(begun_ - 3) % batches_.size()]);
}

void SectorWriter::finish() {
  for (std::size_t i = begun_ > 2 ? begun_ - 2 : 0; i < begun_; ++i)
    write(batches_[i % batches_.size()]);
}

void SectorWriter::write(HitBatch& batch) const {
  target_.resolver.write_batch(target_.request.beams, target_.request.hit_columns, batch,
                               target_.hits);
}

}  // namespace glidar::scan_raster
