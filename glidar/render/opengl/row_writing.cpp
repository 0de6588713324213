// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/row_writing.hpp>

#include <glidar/render/opengl/number_target.hpp>

#include <algorithm>
#include <array>
#include <bit>

namespace glidar::opengl {
namespace {

/// Up to kLanes hits on their way.
struct Work {
  HitBlock block;
  BeamBlock beams;
  ExactBlock exact;
  Lanes<double> x;  ///< where the beams cross the plane at depth 1
  Lanes<double> y;
  std::array<std::uint32_t, kLanes> row;  ///< in the rect
  std::array<std::uint32_t, kLanes> col;
  unsigned used = 0;
};

/// Three are under way at a time, so that what the later steps of one read from memory (planes and
/// corners of its triangles) comes while the next are collected.
struct Works {
  std::array<Work, 3> ring;
  std::size_t started = 0;  ///< the last one is being filled

  Work& filling() { return ring[started % ring.size()]; }
  Work& before() { return ring[(started + ring.size() - 1) % ring.size()]; }
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
bool settle(const RowWriting& w, std::uint32_t doubtful, Work& work) {
  HitBlock& block = work.block;
  bool changed = false;
  for (; doubtful != 0; doubtful &= doubtful - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(doubtful));
    const Found before{block.instance[lane], block.primitive[lane]};
    std::array<Found, 8> around;
    const Found after = w.settler.settle(block.beam[lane], before,
                                         found_around(w, work.row[lane], work.col[lane], around));
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
void finish(const RowWriting& w, Work& work) {
  if (work.used == 0) return;
  HitBlock& block = work.block;
  for (unsigned lane = work.used; lane < kLanes; ++lane) {
    block.beam[lane] = block.beam[0];
    work.x[lane] = work.x[0];
    work.y[lane] = work.y[0];
  }
  work.used = 0;
  directions_through(work.x, work.y, work.beams.direction);
  w.resolver.measure(work.beams, block, work.exact);
  const std::uint32_t in_doubt = doubtful(w.resolver, block, work.exact);
  if (in_doubt != 0 && settle(w, in_doubt, work) && block.mask != 0) {
    w.resolver.measure(work.beams, block, work.exact);
  }
  if (block.mask == 0) return;
  w.resolver.write(w.request.beams, w.request.fields, block, work.exact, w.hits);
}

/// Takes up the next hits, asks for the corners of those before, and finishes those before them.
void go_on(const RowWriting& w, Works& works) {
  Work& full = works.filling();
  full.block.mask = static_cast<std::uint32_t>((std::uint64_t{1} << full.used) - 1);
  HitFields fields = w.request.fields;
  fields.barycentrics = true;  // for their doubts all need their corners
  w.resolver.prefetch_corners(works.before().block, fields);
  ++works.started;
  finish(w, works.filling());
}

void collect_row(const RowWriting& w, std::uint32_t row, Works& works) {
  const std::size_t first =
      std::size_t{w.rect.first_row + row} * w.request.beams.cols + w.rect.first_col;
  const std::uint32_t* numbers = w.numbers.data() + std::size_t{row} * w.rect.cols;
  const double y = w.points.y[w.rect.first_row + row];
  for (std::uint32_t col = 0; col < w.rect.cols; ++col) {
    if (numbers[col] == kNoNumber) continue;
    Work& work = works.filling();
    const unsigned lane = work.used++;
    const Found found = w.drawing.found(numbers[col]);
    work.row[lane] = row;
    work.col[lane] = col;
    work.x[lane] = w.points.x[w.rect.first_col + col];
    work.y[lane] = y;
    work.block.beam[lane] = first + col;
    work.block.instance[lane] = found.instance;
    work.block.primitive[lane] = told(w, found);
    w.resolver.prefetch(work.block, lane);
    if (work.used == kLanes) go_on(w, works);
  }
}

/// All beams of rows [begin, end).
void write_some_rows(const RowWriting& w, std::uint32_t begin, std::uint32_t end) {
  const auto beams_of = [&](std::uint32_t row) {
    const std::size_t first =
        std::size_t{w.rect.first_row + row} * w.request.beams.cols + w.rect.first_col;
    return BeamRange{first, first + w.rect.cols};
  };
  Works works;
  for (std::uint32_t row = begin; row < end; ++row) {
    write_misses(w.request.fields, beams_of(row).begin, w.rect.cols, w.hits);
    collect_row(w, row, works);
  }
  for (std::size_t i = 0; i < works.ring.size(); ++i) go_on(w, works);
  if (!w.request.then) return;
  for (std::uint32_t row = begin; row < end; ++row) w.request.then(beams_of(row));
}

}  // namespace

void write_rows(const RowWriting& writing, Workers& workers, WorkCount& count) {
  constexpr std::uint32_t kBeamsPerTask = 1024;
  const std::uint32_t rows_per_task = std::max(1U, kBeamsPerTask / writing.rect.cols);
  workers.for_ranges(writing.rect.rows, rows_per_task, [&](std::size_t begin, std::size_t end) {
    const auto last = static_cast<std::uint32_t>(end);
    for (auto row = static_cast<std::uint32_t>(begin); row < last; row += rows_per_task) {
      const std::uint32_t next = std::min(row + rows_per_task, last);
      write_some_rows(writing, row, next);
      count.add(std::size_t{next - row} * writing.rect.cols);
    }
  });
}

}  // namespace glidar::opengl
