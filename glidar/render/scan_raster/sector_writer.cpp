// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/sector_writer.hpp>

#include <algorithm>
#include <bit>

namespace glidar::scan_raster {

void SectorWriter::take_beams(Work& work, std::size_t first, unsigned count) const {
  const Beams& beams = target_.request.beams;
  work.beams.has_origins = !beams.origins_m.empty();
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    work.block.beam[lane] = first + std::min(lane, count - 1);
    work.beams.direction.set(lane, beams.directions[work.block.beam[lane]]);
  }
  if (!work.beams.has_origins) return;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    work.beams.origin_m.set(lane, beams.origins_m[work.block.beam[lane]]);
  }
}

/// Sets what the lanes of the mask found.
void SectorWriter::find_cells(const float* numbers, const InstanceSlots& slots, Work& work) const {
  for (std::uint32_t lanes = work.block.mask; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(lanes));
    const Found found = slots.found(std::bit_cast<std::uint32_t>(numbers[lane]));
    work.block.instance[lane] = found.instance;
    work.block.primitive[lane] = found.primitive;
    target_.resolver.prefetch(work.block, lane, needs_corners(target_.request.fields));
  }
}

void SectorWriter::write_rows(const SectorTable& sector, const SectorPicture& picture,
                              const InstanceSlots& slots) {
  const HitFields& fields = target_.request.fields;
  begun_ = 0;
  for (const SectorRow& row : sector.rows()) {
    for (std::uint32_t done = 0; done < row.count; done += kLanes) {
      const unsigned count = std::min(row.count - done, std::uint32_t{kLanes});
      const float* numbers = picture.number + row.first_cell + done;
      Work& work = next();
      work.block.mask = 0;
      for (unsigned lane = 0; lane < count; ++lane) {
        const bool is_hit = std::bit_cast<std::uint32_t>(numbers[lane]) != kNoNumber;
        work.block.mask |= static_cast<std::uint32_t>(is_hit) << lane;
      }
      if (std::popcount(work.block.mask) != static_cast<int>(count)) {
        write_misses(fields, row.first_beam + done, count, target_.hits);
      }
      if (work.block.mask != 0) {
        take_beams(work, row.first_beam + done, count);
        find_cells(numbers, slots, work);
      }
      pass_on();
    }
  }
  finish();
}

void SectorWriter::cast_rays(std::span<const std::size_t> some) {
  const Beams& beams = target_.request.beams;
  begun_ = 0;
  for (std::size_t done = 0; done < some.size(); done += kLanes) {
    const std::size_t count = std::min(some.size() - done, std::size_t{kLanes});
    Work& work = next();
    work.beams.has_origins = !beams.origins_m.empty();
    for (unsigned lane = 0; lane < kLanes; ++lane) {
      const std::size_t beam = some[done + std::min<std::size_t>(lane, count - 1)];
      work.block.beam[lane] = beam;
      work.beams.direction.set(lane, beams.directions[beam]);
      if (work.beams.has_origins) work.beams.origin_m.set(lane, beams.origins_m[beam]);
    }
    work.block.mask = (1U << count) - 1U;
    target_.search.find(work.beams, work.block);
    pass_on();
  }
  finish();
}

/// The block begun last is ready; the one before it goes a step on, the oldest is written.
void SectorWriter::pass_on() {
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
  target_.resolver.measure(work.beams, work.block, work.exact);
  target_.resolver.write(target_.request.beams, target_.request.fields, work.block, work.exact,
                         target_.hits);
}

}  // namespace glidar::scan_raster
