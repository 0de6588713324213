// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/stereo/path_sums.hpp>

#include <glidar/stereo/wavefront.hpp>

#include <algorithm>
#include <vector>

namespace glidar::stereo {

namespace {

/// Rows whose costs a thread computes before their paths continue: they stay in the cache.
constexpr std::size_t kBandRows = 16;
/// Pixels between checks of the row before.
constexpr std::size_t kChunkPixels = 64;
constexpr std::size_t kMaxDownPaths = 3;

std::size_t thread_count(const StereoRun& run) {
  return run.pool == nullptr ? 1 : run.pool->threads();
}

/// Path costs from one row to the next. Each path has its own place, so that rows replace states
/// without copies: the path straight down at x, the diagonals at x - row + height and x + row.
class DownPaths {
 public:
  DownPaths(const CostVolume& volume, const StereoOptions& options)
      : volume_(volume),
        paths_(options.paths == 8 ? 3 : 1),
        stride_(volume.lanes + kStateGap),
        p1_(static_cast<std::int16_t>(penalty_p1(options))),
        p2_(static_cast<std::int16_t>(penalty_p2(options))) {
    const std::size_t places = volume.width + volume.height;
    for (std::size_t k = 0; k < paths_; ++k) {
      least_[k].assign(places, 0);
      state_[k].assign(places * stride_ + kStateGap, kNoCost);
      for (std::size_t place = 0; place < places; ++place) {  // before its first pixel: no cost
        std::fill_n(state_[k].data() + kStateGap + place * stride_, volume.lanes, std::int16_t{0});
      }
    }
  }

  /// Pixels from x of row y, which is the row-th of its direction. The sums go to `new_sum`, which
  /// has those of the whole row.
  void advance(const Kernel& kernel, std::size_t row, std::size_t y, std::size_t chunk,
               std::int16_t* new_sum) {
    const std::size_t x = chunk * kChunkPixels;
    const std::size_t place[kMaxDownPaths] = {x, x + volume_.height - 1 - row, x + row};
    const std::size_t offset = volume_.offset(y) + x * volume_.lanes;
    DownRow work = {.cost = volume_.cost.data() + offset,
                    .sum = volume_.sum.data() + offset,
                    .new_sum = new_sum + x * volume_.lanes,
                    .count = std::min(kChunkPixels, volume_.width - x),
                    .lanes = volume_.lanes,
                    .disparities = volume_.disparities,
                    .p1 = p1_,
                    .p2 = p2_,
                    .paths = paths_};
    for (std::size_t k = 0; k < paths_; ++k) {
      work.state[k] = state_[k].data() + kStateGap + place[k] * stride_;
      work.least[k] = least_[k].data() + place[k];
    }
    kernel.down(work);
  }

 private:
  const CostVolume& volume_;
  std::size_t paths_;
  std::size_t stride_;
  std::int16_t p1_;
  std::int16_t p2_;
  std::vector<std::int16_t> state_[kMaxDownPaths];
  std::vector<std::int16_t> least_[kMaxDownPaths];
};

std::size_t chunk_count(const CostVolume& volume) {
  return (volume.width + kChunkPixels - 1) / kChunkPixels;
}

/// Costs of rows [begin, end) and paths along them, a band per thread.
void fill_bands(const CostSource& source, const StereoRun& run, std::size_t begin, std::size_t end,
                CostVolume& volume, std::vector<CostWorkspace>& workspaces) {
  const auto fill = [&](std::size_t first, std::size_t last) {
    for (std::size_t band = first; band < last; ++band) {
      const std::size_t from = begin + band * kBandRows;
      fill_rows(source, from, std::min(from + kBandRows, end), volume, workspaces[band]);
    }
  };
  const std::size_t bands = (end - begin + kBandRows - 1) / kBandRows;
  if (run.pool == nullptr || bands == 1) return fill(0, bands);
  run.pool->parallel_for(bands, 1, fill);
}

void sum_from_above(const CostSource& source, const StereoRun& run, CostVolume& volume,
                    ProgressCounter& progress) {
  DownPaths paths(volume, source.options);
  std::vector<CostWorkspace> workspaces(thread_count(run));
  const std::size_t rows = kBandRows * thread_count(run);
  for (std::size_t begin = 0; begin < volume.height; begin += rows) {
    const std::size_t end = std::min(begin + rows, volume.height);
    fill_bands(source, run, begin, end, volume, workspaces);
    const auto chunk = [&](std::size_t, std::size_t row, std::size_t index) {
      const std::size_t y = begin + row;
      paths.advance(source.kernel, y, y, index, volume.sum.data() + volume.offset(y));
    };
    Wavefront(end - begin, chunk_count(volume)).run(run.pool, chunk, [&](std::size_t, std::size_t) {
      progress.add(1);
    });
  }
}

void sum_from_below(const CostSource& source, const StereoRun& run, CostVolume& volume,
                    RowSumsFunction on_row, ProgressCounter& progress) {
  DownPaths paths(volume, source.options);
  std::vector<std::vector<std::int16_t>> rows(thread_count(run));
  if (!run.keeps_costs) {
    for (auto& row : rows) row.resize(volume.row_size());
  }
  const auto sums_of = [&](std::size_t worker, std::size_t y) {
    return run.keeps_costs ? volume.sum.data() + volume.offset(y) : rows[worker].data();
  };
  const auto chunk = [&](std::size_t worker, std::size_t row, std::size_t index) {
    const std::size_t y = volume.height - 1 - row;
    paths.advance(source.kernel, row, y, index, sums_of(worker, y));
  };
  const auto finish = [&](std::size_t worker, std::size_t row) {
    const std::size_t y = volume.height - 1 - row;
    on_row(worker, y, sums_of(worker, y));
    progress.add(1);
  };
  Wavefront(volume.height, chunk_count(volume)).run(run.pool, chunk, finish);
}

}  // namespace

std::size_t progress_rows(const CostVolume& volume) {
  return 2 * volume.height;
}

void sum_paths(const CostSource& source, const StereoRun& run, CostVolume& volume,
               RowSumsFunction on_row, ProgressCounter& progress) {
  sum_from_above(source, run, volume, progress);
  sum_from_below(source, run, volume, on_row, progress);
}

}  // namespace glidar::stereo
