// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/row_writing.hpp>

#include <glidar/render/opengl/number_target.hpp>

#include <algorithm>
#include <array>
#include <bit>

namespace glidar::opengl {
namespace {

/// Up to kLanes hits of one row on their way.
struct Work {
  HitBlock block;
  BeamBlock beams;
  ExactBlock exact;
  std::array<std::uint32_t, kLanes> col;  ///< in the rect
  unsigned used = 0;
};

/// The triangle to tell for one found, see Resolver::told.
std::uint32_t told(const RowWriting& w, const Found& found) {
  return w.request.cull_back_faces ? found.primitive
                                   : w.resolver.told(found.instance, found.primitive);
}

/// What was drawn at the up to eight pixels around one.
std::span<const Found> found_around(const RowWriting& w, std::uint32_t row, std::uint32_t col,
                                    std::array<Found, 8>& found) {
  std::size_t used = 0;
  const std::uint32_t end_row = std::min(row + 2, w.rect.rows);
  const std::uint32_t end_col = std::min(col + 2, w.rect.cols);
  for (std::uint32_t r = row == 0 ? 0 : row - 1; r < end_row; ++r) {
    for (std::uint32_t c = col == 0 ? 0 : col - 1; c < end_col; ++c) {
      if (r == row && c == col) continue;
      found[used++] = w.drawing.found(w.numbers[std::size_t{r} * w.rect.cols + c]);
    }
  }
  return {found.data(), used};
}

/// Puts right the lanes in doubt; true when that changed the block.
bool settle(const RowWriting& w, std::uint32_t row, std::uint32_t doubtful, Work& work) {
  HitBlock& block = work.block;
  bool changed = false;
  for (; doubtful != 0; doubtful &= doubtful - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(doubtful));
    const Found before{block.instance[lane], block.primitive[lane]};
    std::array<Found, 8> around;
    const Found after =
        w.settler.settle(block.beam[lane], before, found_around(w, row, work.col[lane], around));
    if (after == before) continue;
    changed = true;
    if (after.instance == kNoHit) {
      block.mask &= ~(1U << lane);
      continue;
    }
    block.instance[lane] = after.instance;
    block.primitive[lane] = told(w, after);
  }
  return changed;
}

/// Writes the collected hits over the misses that stand there.
void finish(const RowWriting& w, std::uint32_t row, Work& work) {
  if (work.used == 0) return;
  HitBlock& block = work.block;
  block.mask = static_cast<std::uint32_t>((std::uint64_t{1} << work.used) - 1);
  for (unsigned lane = work.used; lane < kLanes; ++lane) {
    block.beam[lane] = block.beam[0];
    work.beams.direction.set(lane, work.beams.direction.get(0));
  }
  work.used = 0;
  w.resolver.measure(work.beams, block, work.exact);
  const std::uint32_t in_doubt = doubtful(w.resolver, block, work.exact);
  if (in_doubt != 0 && settle(w, row, in_doubt, work) && block.mask != 0) {
    w.resolver.measure(work.beams, block, work.exact);
  }
  if (block.mask == 0) return;
  w.resolver.write(w.request.beams, w.request.fields, block, work.exact, w.hits);
}

void write_row(const RowWriting& w, std::uint32_t row, Work& work) {
  const Beams& beams = w.request.beams;
  const std::size_t first = std::size_t{w.rect.first_row + row} * beams.cols + w.rect.first_col;
  write_misses(w.request.fields, first, w.rect.cols, w.hits);
  const std::uint32_t* numbers = w.numbers.data() + std::size_t{row} * w.rect.cols;
  for (std::uint32_t col = 0; col < w.rect.cols; ++col) {
    if (numbers[col] == kNoNumber) continue;
    const unsigned lane = work.used++;
    const Found found = w.drawing.found(numbers[col]);
    work.col[lane] = col;
    work.block.beam[lane] = first + col;
    work.block.instance[lane] = found.instance;
    work.block.primitive[lane] = told(w, found);
    work.beams.direction.set(lane, beams.directions[first + col]);
    w.resolver.prefetch(work.block, lane);
    if (work.used == kLanes) finish(w, row, work);
  }
  finish(w, row, work);
  if (w.request.then) w.request.then({first, first + w.rect.cols});
}

}  // namespace

void write_rows(const RowWriting& writing, Workers& workers, WorkCount& count) {
  constexpr std::uint32_t kBeamsPerTask = 1024;
  const std::size_t rows_per_task = std::max(1U, kBeamsPerTask / writing.rect.cols);
  workers.for_ranges(writing.rect.rows, rows_per_task, [&](std::size_t begin, std::size_t end) {
    Work work;
    for (std::size_t row = begin; row < end; ++row) {
      write_row(writing, static_cast<std::uint32_t>(row), work);
      count.add(writing.rect.cols);
    }
  });
}

}  // namespace glidar::opengl
