// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/hit_writer.hpp>

#include <glidar/render/uncertain_hits.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <vector>

namespace glidar {
namespace {

constexpr std::uint32_t kColumnsAtOnce = 128;  // columns that are looked through at once

/// Up to kLanes hits on their way.
struct Work {
  HitBlock block;
  BeamBlock beams;
  ExactBlock exact;
  Lanes<double> x;  ///< where the beams cross the plane at depth 1
  Lanes<double> y;
  std::array<std::uint32_t, kLanes> number;  ///< drawn there
  std::uint32_t certain = 0;                 ///< bit i: lane i meets its triangle
  std::uint32_t contested = 0;               ///< bit i: lane i may meet another one before
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
std::uint32_t told(const PictureWriting& w, const Found& found) {
  return w.request.cull_back_faces ? found.primitive
                                   : w.resolver.told(found.instance, found.primitive);
}

bool is_close(const PictureWriting& w, const Found& found) {
  return w.sheets != nullptr &&
         w.sheets->is_close(found.instance, w.resolver.told(found.instance, found.primitive));
}

/// Puts these lanes right by the hit rule; true when that changed the block.
bool correct(const PictureWriting& w, std::uint32_t lanes, const BeamBlock& beams,
             HitBlock& block) {
  HitBlock exact = block;
  exact.mask = lanes;
  w.search.find(beams, exact);
  bool changed = false;
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(lanes));
    if ((exact.mask >> lane & 1U) == 0) {
      changed = true;
      block.mask &= ~(1U << lane);
      write_misses(w.request.fields, block.beam[lane], 1, w.hits);
      continue;
    }
    changed = changed || block.instance[lane] != exact.instance[lane] ||
              block.primitive[lane] != exact.primitive[lane];
    block.instance[lane] = exact.instance[lane];
    block.primitive[lane] = exact.primitive[lane];
  }
  return changed;
}

/// A bit for every lane whose hit lies in front of the beam's start.
std::uint32_t ahead(const ExactBlock& exact) {
  std::uint32_t mask = 0;
  for (unsigned i = 0; i < kLanes; ++i) {
    mask |= static_cast<std::uint32_t>(exact.distance[i] > 0.0) << i;
  }
  return mask;
}

/// Decides between surfaces of several instances that lie closer together than the picture shows.
void choose_among_instances(const PictureWriting& w, Work& work) {
  const std::uint32_t lanes = w.overlaps.lanes_near(work.block, work.beams, work.exact);
  if (lanes != 0 && correct(w, lanes, work.beams, work.block) && work.block.mask != 0) {
    w.resolver.measure(work.beams, work.block, work.exact);
  }
}

/// Writes the collected hits.
void finish(const PictureWriting& w, Work& work) {
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
  const std::uint32_t uncertain = block.mask & ~(work.certain & ahead(work.exact));
  const std::uint32_t beside =
      uncertain == 0 ? 0 : doubtful(w.resolver, block, work.exact) & uncertain;
  const std::uint32_t in_doubt = beside | (work.contested & block.mask);
  if (in_doubt != 0 && correct(w, in_doubt, work.beams, block) && block.mask != 0) {
    w.resolver.measure(work.beams, block, work.exact);
  }
  if (block.mask == 0) return;
  if (w.overlaps.has_any()) choose_among_instances(w, work);
  if (block.mask == 0) return;
  w.resolver.write(w.request.beams, w.request.fields, block, work.exact, w.hits);
}

/// What the numbers of a block tell.
void look_up(const PictureWriting& w, Work& work) {
  work.block.mask = static_cast<std::uint32_t>((std::uint64_t{1} << work.used) - 1);
  work.certain = 0;
  work.contested = 0;
  const bool with_corners = needs_corners(w.request.fields);
  for (unsigned lane = 0; lane < work.used; ++lane) {
    work.certain |= static_cast<std::uint32_t>((work.number[lane] & kCertain) != 0) << lane;
    const Found found = w.triangles.found(work.number[lane]);
    const bool is_contested = (work.number[lane] & kContested) != 0 || is_close(w, found);
    work.contested |= static_cast<std::uint32_t>(is_contested) << lane;
    work.block.instance[lane] = found.instance;
    work.block.primitive[lane] = told(w, found);
    w.resolver.prefetch(work.block, lane, with_corners);
  }
}

/// Looks the collected hits up, asks for the corners of those before, and finishes those before
/// them.
void go_on(const PictureWriting& w, Works& works) {
  look_up(w, works.filling());
  Work& before = works.before();
  HitFieldMask fields = w.request.fields;
  // For their doubts.
  fields.barycentrics = fields.barycentrics || (before.block.mask & ~before.certain) != 0;
  w.resolver.prefetch_corners(before.block, fields);
  ++works.started;
  finish(w, works.filling());
}

/// Lists the columns of a piece of a row where something was drawn; returns how many.
std::uint32_t list_drawn(const std::uint32_t* numbers, std::uint32_t begin, std::uint32_t end,
                         std::array<std::uint32_t, kColumnsAtOnce>& cols) {
  std::uint32_t count = 0;
  for (std::uint32_t col = begin; col < end; ++col) {  // a branch would often be mistaken
    cols[count] = col;
    count += numbers[col] != kNoNumber ? 1U : 0U;
  }
  return count;
}

void collect(const PictureWriting& w, std::uint32_t row, std::uint32_t col, std::uint32_t number,
             Work& work) {
  const std::uint32_t picture_row = w.drawn.first_row + row;
  const std::uint32_t picture_col = w.drawn.first_col + col;
  const unsigned lane = work.used++;
  work.number[lane] = number;
  work.x[lane] = w.points.x[picture_col];
  work.y[lane] = w.points.y[picture_row];
  work.block.beam[lane] = std::size_t{picture_row} * w.request.beams.cols + picture_col;
}

/// The beams of a row of the part.
BeamRange beams_of(const PictureWriting& w, std::uint32_t row) {
  const std::size_t first =
      std::size_t{w.part.first_row + row} * w.request.beams.cols + w.part.first_col;
  return {first, first + w.part.cols};
}

void collect_row(const PictureWriting& w, std::uint32_t row, Works& works) {
  const std::size_t first = beams_of(w, row).begin;
  const std::uint32_t drawn_row = w.part.first_row - w.drawn.first_row + row;
  const std::uint32_t drawn_col = w.part.first_col - w.drawn.first_col;
  const std::uint32_t* numbers =
      w.numbers.data() + std::size_t{drawn_row} * w.drawn.cols + drawn_col;
  std::array<std::uint32_t, kColumnsAtOnce> cols;
  for (std::uint32_t begin = 0; begin < w.part.cols; begin += kColumnsAtOnce) {
    const std::uint32_t end = std::min(begin + kColumnsAtOnce, w.part.cols);
    const std::uint32_t count = list_drawn(numbers, begin, end, cols);
    // In long strokes, hits being written over them; only where all are hits there is no need.
    if (count < end - begin) write_misses(w.request.fields, first + begin, end - begin, w.hits);
    Work* work = &works.filling();
    for (std::uint32_t i = 0; i < count; ++i) {
      collect(w, drawn_row, drawn_col + cols[i], numbers[cols[i]], *work);
      if (work->used < kLanes) continue;
      go_on(w, works);
      work = &works.filling();
    }
  }
}

/// Writes the hits that are known without the picture over what it shows. The beams in the range
/// that belong to columns beside the part are not known.
void write_known(const PictureWriting& w, const BeamRange& beams) {
  const auto first =
      std::lower_bound(w.known.begin(), w.known.end(), beams.begin,
                       [](const KnownHit& hit, std::size_t beam) { return hit.beam < beam; });
  Work work;
  work.certain = 0xffffffffU;
  work.block.mask = 0;
  for (auto hit = first; hit != w.known.end() && hit->beam < beams.end; ++hit) {
    if (hit->found.instance == kInvalidId) {
      write_misses(w.request.fields, hit->beam, 1, w.hits);
      continue;
    }
    const unsigned lane = work.used++;
    work.x[lane] = w.points.x[hit->beam % w.request.beams.cols];
    work.y[lane] = w.points.y[hit->beam / w.request.beams.cols];
    work.block.beam[lane] = hit->beam;
    work.block.instance[lane] = hit->found.instance;
    work.block.primitive[lane] = told(w, hit->found);
    work.block.mask |= 1U << lane;
    if (work.used < kLanes) continue;
    finish(w, work);
    work.block.mask = 0;
  }
  finish(w, work);
}

}  // namespace

DepthRange depths_of(const CastRequest& request, const Resolver& resolver,
                     std::span<const Eigen::AlignedBox3d> mesh_boxes) {
  double nearest_m = std::numeric_limits<double>::infinity();
  double farthest_m = -std::numeric_limits<double>::infinity();
  const std::vector<Instance>& instances = resolver.scene().instances;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (!is_enabled(request, i)) continue;
    extend_depths(resolver.view(i), mesh_boxes[instances[i].mesh], nearest_m, farthest_m);
  }
  if (!(farthest_m > 0.0)) return {0.0, 0.0};
  return hugging(nearest_m, farthest_m);
}

void write_rows(const PictureWriting& w, std::uint32_t begin, std::uint32_t end) {
  Works works;
  for (std::uint32_t row = begin; row < end; ++row) collect_row(w, row, works);
  for (std::size_t i = 0; i < works.ring.size(); ++i) go_on(w, works);
  if (!w.known.empty()) write_known(w, {beams_of(w, begin).begin, beams_of(w, end - 1).end});
  if (!w.request.on_tile_done) return;
  for (std::uint32_t row = begin; row < end; ++row) w.request.on_tile_done(beams_of(w, row));
}

void write_picture(const PictureWriting& writing, ThreadPool& thread_pool, ProgressCounter& count) {
  constexpr std::uint32_t kBeamsPerTask = 1024;
  const PixelRect& part = writing.part;
  const std::uint32_t rows_per_task = std::max(1U, kBeamsPerTask / part.cols);
  thread_pool.parallel_for(part.rows, rows_per_task, [&](std::size_t begin, std::size_t end) {
    const auto last = static_cast<std::uint32_t>(end);
    for (auto row = static_cast<std::uint32_t>(begin); row < last; row += rows_per_task) {
      const std::uint32_t next = std::min(row + rows_per_task, last);
      write_rows(writing, row, next);
      count.add(std::size_t{next - row} * part.cols);
    }
  });
}

}  // namespace glidar
