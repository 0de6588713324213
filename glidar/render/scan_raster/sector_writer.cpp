// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/sector_writer.hpp>

#include <algorithm>
#include <bit>
#include <cstring>

namespace glidar::scan_raster {

void SectorWriter::take_beams(const SectorTable& sector, const RowRun& run, Work& work) const {
  const Beams& beams = target_.request.beams;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    work.block.beam[lane] = run.first_beam + std::min(lane, run.count - 1);
  }
  // Whole vectors are copied, since vectors written one number at a time are slow to load.
  Lanes3<double>& direction = work.beams.direction;
  const auto take = [&](int axis, Lanes<double>& component) {
    std::memcpy(&component, sector.exact_direction(axis) + run.first_cell, sizeof(component));
  };
  take(0, direction.x);
  take(1, direction.y);
  take(2, direction.z);
  work.beams.has_origins = !beams.origins_m.empty();
  if (!work.beams.has_origins) return;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    work.beams.origin_m.set(lane, beams.origins_m[work.block.beam[lane]]);
  }
}

/// Sets the hits of the mask's lanes. Neighbours mostly have the same triangle.
void SectorWriter::find_cells(const float* numbers, const InstanceSlots& slots, Work& work) {
  HitBlock& block = work.block;
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
    if (is_new) target_.resolver.prefetch(block, lane, with_corners_);
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
  Work& work = next();
  work.block.mask = 0;
  for (unsigned lane = 0; lane < run.count; ++lane) {
    const bool is_hit = std::bit_cast<std::uint32_t>(numbers[lane]) != kNoSlotNumber;
    work.block.mask |= static_cast<std::uint32_t>(is_hit) << lane;
  }
  if (work.block.mask != (1U << run.count) - 1U) {
    write_misses(target_.request.fields, run.first_beam, run.count, target_.hits);
  }
  if (work.block.mask != 0) {
    work.block.is_run = work.block.mask == (1U << kLanes) - 1U;
    take_beams(sector, run, work);
    find_cells(numbers, slots, work);
  }
  advance();
}

void SectorWriter::cast_rays(std::span<const std::size_t> some) {
  const Beams& beams = target_.request.beams;
  begun_ = 0;
  for (std::size_t done = 0; done < some.size(); done += kLanes) {
    const std::size_t count = std::min(some.size() - done, std::size_t{kLanes});
    Work& work = next();
    work.block.is_one_triangle = false;
    work.block.is_run = false;
    work.beams.has_origins = !beams.origins_m.empty();
    for (unsigned lane = 0; lane < kLanes; ++lane) {
      const std::size_t beam = some[done + std::min<std::size_t>(lane, count - 1)];
      work.block.beam[lane] = beam;
      work.beams.direction.set(lane, beams.directions[beam]);
      if (work.beams.has_origins) work.beams.origin_m.set(lane, beams.origins_m[beam]);
    }
    work.block.mask = (1U << count) - 1U;
    target_.search.find(work.beams, work.block);
    advance();
  }
  finish();
}

/// Advances the pipeline: prefetches for the batch before the last, and writes the oldest.
void SectorWriter::advance() {
  if (begun_ >= 2) {
    target_.resolver.prefetch_corners(ring_[(begun_ - 2) % ring_.size()].block,
                                      target_.request.fields);
  }
  if (begun_ >= 3) write(ring_[(begun_ - 3) % ring_.size()]);
}

void SectorWriter::finish() {
  for (std::size_t i = begun_ > 2 ? begun_ - 2 : 0; i < begun_; ++i) write(ring_[i % ring_.size()]);
}

void SectorWriter::write(Work& work) const {
  if (work.block.mask == 0) return;
  target_.resolver.intersect(work.beams, work.block, work.exact);
  target_.resolver.write(target_.request.beams, target_.request.fields, work.block, work.exact,
                         target_.hits);
}

}  // namespace glidar::scan_raster
