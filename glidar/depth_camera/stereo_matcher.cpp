// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/stereo_matcher.hpp>

#include <glidar/core/function_ref.hpp>
#include <glidar/core/instruction_set.hpp>
#include <glidar/core/report.hpp>
#include <glidar/depth_camera/stereo.hpp>
#include <glidar/depth_camera/stereo_kernel.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/thread_pool.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <thread>
#include <vector>

namespace glidar::stereo {

// Of stereo_kernel.cpp, which is compiled for each instruction set.
namespace baseline {
extern const Kernel kKernel;
}
#ifdef __x86_64__
namespace avx2 {
extern const Kernel kKernel;
}
namespace avx512 {
extern const Kernel kKernel;
}
#endif

namespace {

/// Sums over the window of each pixel, of 2 radius + 1 rows and columns, as far as it is inside the
/// image.
struct WindowSums {
  std::vector<std::uint32_t> step;       ///< |level(x + 1) - level(x)|
  std::vector<std::uint16_t> saturated;  ///< pixels of at least the saturation level
  std::vector<std::uint16_t> pixels;     ///< pixels in the window
};

constexpr std::size_t kSumBandRows = 32;

/// Sums of columns over the rows of the window.
struct ColumnSums {
  std::vector<std::uint32_t> step;
  std::vector<std::uint32_t> saturated;
};

/// Adds the row `count` times: 1, or -1 in unsigned arithmetic.
void add_image_row(const GreyImage& image, std::size_t y, std::uint32_t saturation_level,
                   std::uint32_t count, ColumnSums& sums) {
  const std::uint16_t* const level = image.level.data() + y * image.width;
  for (std::size_t x = 0; x < image.width; ++x) {
    sums.saturated[x] += level[x] >= saturation_level ? count : 0;
  }
  for (std::size_t x = 0; x + 1 < image.width; ++x) {
    const std::uint32_t step =
        level[x] > level[x + 1] ? level[x] - level[x + 1] : level[x + 1] - level[x];
    sums.step[x] += step * count;
  }
}

void sum_row(const ColumnSums& columns, std::size_t radius, std::size_t rows, std::size_t offset,
             WindowSums& windows) {
  const std::size_t width = columns.step.size();
  std::uint32_t step = 0;
  std::uint32_t saturated = 0;
  for (std::size_t x = 0; x < std::min(radius, width); ++x) {
    step += columns.step[x];
    saturated += columns.saturated[x];
  }
  for (std::size_t x = 0; x < width; ++x) {
    const std::size_t added = x + radius;
    if (added < width) {
      step += columns.step[added];
      saturated += columns.saturated[added];
    }
    if (x > radius) {
      step -= columns.step[x - radius - 1];
      saturated -= columns.saturated[x - radius - 1];
    }
    const std::size_t inside = std::min(added, width - 1) - (x > radius ? x - radius : 0) + 1;
    windows.step[offset + x] = step;
    windows.saturated[offset + x] = static_cast<std::uint16_t>(saturated);
    windows.pixels[offset + x] = static_cast<std::uint16_t>(inside * rows);
  }
}

void sum_band(const GreyImage& image, std::size_t radius, std::uint32_t saturation_level,
              std::size_t band, WindowSums& windows) {
  const std::size_t begin = band * kSumBandRows;
  const std::size_t end = std::min<std::size_t>(begin + kSumBandRows, image.height);
  ColumnSums columns = {std::vector<std::uint32_t>(image.width),
                        std::vector<std::uint32_t>(image.width)};
  std::size_t first = begin > radius ? begin - radius : 0;
  std::size_t next = first;
  for (std::size_t y = begin; y < end; ++y) {
    for (; next <= y + radius && next < image.height; ++next) {
      add_image_row(image, next, saturation_level, 1, columns);
    }
    for (; first + radius < y; ++first) {
      add_image_row(image, first, saturation_level, ~0U, columns);
    }
    sum_row(columns, radius, next - first, y * image.width, windows);
  }
}

/// `pool` may be null.
WindowSums sum_windows(const GreyImage& image, std::uint32_t radius, std::uint32_t saturation_level,
                       ThreadPool* pool) {
  WindowSums windows;
  const std::size_t count = std::size_t{image.width} * image.height;
  windows.step.resize(count);
  windows.saturated.resize(count);
  windows.pixels.resize(count);
  const auto sum = [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = begin; band < end; ++band) {
      sum_band(image, radius, saturation_level, band, windows);
    }
  };
  const std::size_t bands = (image.height + kSumBandRows - 1) / kSumBandRows;
  if (pool == nullptr) {
    sum(0, bands);
  } else {
    pool->parallel_for(bands, 1, sum);
  }
  return windows;
}

/// Receives a row whose sums over all paths are complete. Calls of one worker, a number below that
/// of threads, never overlap.
using RowSumsFunction =
    FunctionRef<void(std::size_t worker, std::size_t y, const std::int16_t* sums)>;

/// Processes the chunks of rows in order: chunk c of a row after the chunks up to c + 1 of the row
/// before. Threads take rows in order, so the first row in work never waits for another thread.
class Wavefront {
 public:
  Wavefront(std::size_t rows, std::size_t chunks) : chunks_(chunks), done_(rows) {}

  /// Calls row_chunk(worker, row, chunk) for all, and finish(worker, row) after the last chunk of a
  /// row. Calls of one worker, a number below that of threads, never overlap. `pool` may be null.
  template <class RowChunk, class Finish>
  void run(ThreadPool* pool, const RowChunk& row_chunk, const Finish& finish) {
    std::atomic<std::size_t> workers{0};
    const auto work = [&](std::size_t, std::size_t) { take_rows(workers++, row_chunk, finish); };
    if (pool == nullptr || pool->threads() == 1) return work(0, 1);
    pool->parallel_for(pool->threads(), 1, work);
  }

 private:
  template <class RowChunk, class Finish>
  void take_rows(std::size_t worker, const RowChunk& row_chunk, const Finish& finish) {
    for (std::size_t row = next_++; row < done_.size(); row = next_++) {
      for (std::size_t chunk = 0; chunk < chunks_; ++chunk) {
        if (row > 0) wait_for(row - 1, chunk + 2 < chunks_ ? chunk + 2 : chunks_);
        row_chunk(worker, row, chunk);
        done_[row].store(chunk + 1, std::memory_order_release);
      }
      finish(worker, row);
    }
  }

  void wait_for(std::size_t row, std::size_t chunks) const {
    while (done_[row].load(std::memory_order_acquire) < chunks) std::this_thread::yield();
  }

  std::size_t chunks_;
  std::atomic<std::size_t> next_{0};
  std::vector<std::atomic<std::size_t>> done_;
};

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

/// Rows that count as finished in the progress of sum_paths().
std::size_t progress_rows(const CostVolume& volume) {
  return 2 * volume.height;
}

/// Computes the costs of all pixels and their sums over all paths: first the costs, the paths along
/// rows and those from the row above, then the paths from the row below. With `keeps_costs`, the
/// sums are in the volume afterwards.
void sum_paths(const CostSource& source, const StereoRun& run, CostVolume& volume,
               RowSumsFunction on_row, ProgressCounter& progress) {
  sum_from_above(source, run, volume, progress);
  sum_from_below(source, run, volume, on_row, progress);
}

/// The inner loops for an instruction set, which the processor must have.
const Kernel& kernel_for(InstructionSet set) {
#ifdef __x86_64__
  if (set == InstructionSet::avx512) return avx512::kKernel;
  if (set == InstructionSet::avx2) return avx2::kKernel;
#endif
  (void)set;  // elsewhere there is one
  return baseline::kKernel;
}

std::uint32_t saturation_level(const GreyImage& image, const StereoOptions& options) {
  return options.saturation_level == 0 ? image.max_level : options.saturation_level;
}

/// Memory of a thread for the winners of a row.
struct WinnerWorkspace {
  std::vector<std::int16_t> best;
  std::vector<std::int16_t> winner;
  std::vector<std::int16_t> rivals;
  std::vector<std::int16_t> mirror_best;
  std::vector<std::int16_t> mirror_winner;
};

WinnerWorkspace make_workspace(const CostVolume& volume) {
  const std::size_t width = volume.width;
  return {std::vector<std::int16_t>(width), std::vector<std::int16_t>(width),
          std::vector<std::int16_t>(width), std::vector<std::int16_t>(width + volume.lanes),
          std::vector<std::int16_t>(width + volume.lanes)};
}

/// Selects winners row by row and tests them.
class WinnerRows {
 public:
  WinnerRows(const CostSource& source, const CostVolume& volume, const WindowSums& windows,
             std::size_t threads, StereoMatch& match)
      : source_(source),
        volume_(volume),
        windows_(windows),
        workspaces_(threads, make_workspace(volume)),
        match_(match) {}

  void finish(std::size_t worker, std::size_t y, const std::int16_t* sums) {
    WinnerWorkspace& work = workspaces_[worker];
    source_.kernel.win({.sum = sums,
                        .width = volume_.width,
                        .lanes = volume_.lanes,
                        .disparities = volume_.disparities,
                        .uniqueness_percent = source_.options.uniqueness_percent,
                        .best = work.best.data(),
                        .winner = work.winner.data(),
                        .rivals = work.rivals.data(),
                        .mirror_best = work.mirror_best.data(),
                        .mirror_winner = work.mirror_winner.data()});
    float next_disparity_px = -1.0F;
    for (std::size_t x = volume_.width; x-- > 0;) {
      const std::int16_t* const at = sums + x * volume_.lanes;
      PixelEvidence pixel = evidence(work, x, y, at);
      pixel.next_disparity_px = next_disparity_px;
      set_pixel(x, y, pixel, at);
      const float disparity_px = match_.disparity_px[y * volume_.width + x];
      if (!std::isnan(disparity_px)) next_disparity_px = disparity_px;
    }
  }

 private:
  [[nodiscard]] PixelEvidence evidence(const WinnerWorkspace& work, std::size_t x, std::size_t y,
                                       const std::int16_t* sums) const {
    const auto winner = static_cast<std::uint32_t>(work.winner[x]);
    const std::size_t pixel = y * volume_.width + x;
    const std::size_t mirrored = volume_.width - 1 - x + winner;
    return {.column = static_cast<std::uint32_t>(x),
            .winner = winner,
            .right_winner = static_cast<std::uint32_t>(work.mirror_winner[mirrored]),
            .rivals = without_neighbours(static_cast<std::uint32_t>(work.rivals[x]), winner,
                                         source_.options, sums),
            .step_sum = windows_.step[pixel],
            .saturated_pixels = windows_.saturated[pixel],
            .window_pixels = windows_.pixels[pixel]};
  }

  void set_pixel(std::size_t x, std::size_t y, const PixelEvidence& evidence,
                 const std::int16_t* sums) {
    const StereoOptions& options = source_.options;
    const std::size_t pixel = y * volume_.width + x;
    const StereoStatus status = classify(evidence, options);
    match_.status[pixel] = status;
    if (status != StereoStatus::valid) return;
    const std::int16_t* const at = sums + evidence.winner;
    // a test keeps winners off both ends of the search
    const double offset =
        corrected_offset(subpixel_offset(options.subpixel, at[-1], at[0], at[1]), options.a_factor);
    match_.disparity_px[pixel] = static_cast<float>(rounded_disparity(
        options.min_disparity_px + evidence.winner + offset, options.steps_per_px));
  }

  const CostSource& source_;
  const CostVolume& volume_;
  const WindowSums& windows_;
  std::vector<WinnerWorkspace> workspaces_;
  StereoMatch& match_;
};

StereoMatch empty_match(const GreyImage& image, const StereoOptions& options) {
  const std::size_t pixels = std::size_t{image.width} * image.height;
  StereoMatch match;
  match.width = image.width;
  match.height = image.height;
  match.disparities = options.disparities;
  match.min_disparity_px = options.min_disparity_px;
  match.disparity_px.assign(pixels, kNaNf);
  match.status.assign(pixels, StereoStatus::valid);
  return match;
}

/// The lane that right column `column` of row y selects: the first of its least sums.
std::uint32_t right_winner(const CostVolume& volume, std::int64_t column, std::size_t y) {
  std::uint32_t winner = 0;
  std::int16_t lowest = 32767;
  for (std::size_t d = 0; d < volume.disparities; ++d) {
    const std::int64_t x = column + static_cast<std::int64_t>(d);
    if (x < 0 || x >= static_cast<std::int64_t>(volume.width)) continue;
    const std::int16_t sum =
        volume.sum.data()[volume.offset(y) + static_cast<std::size_t>(x) * volume.lanes + d];
    if (sum >= lowest) continue;
    lowest = sum;
    winner = static_cast<std::uint32_t>(d);
  }
  return winner;
}

void add_window(const GreyImage& image, const StereoOptions& options, std::uint32_t x,
                std::uint32_t y, PixelEvidence& evidence) {
  const std::uint32_t radius = window_radius_px(options);
  evidence.window_pixels = 0;
  for (std::uint32_t v = y > radius ? y - radius : 0; v <= y + radius && v < image.height; ++v) {
    for (std::uint32_t u = x > radius ? x - radius : 0; u <= x + radius && u < image.width; ++u) {
      const std::size_t pixel = std::size_t{v} * image.width + u;
      const int level = image.level[pixel];
      ++evidence.window_pixels;
      if (image.level[pixel] >= saturation_level(image, options)) ++evidence.saturated_pixels;
      if (u + 1 == image.width) continue;
      evidence.step_sum += static_cast<std::uint32_t>(std::abs(level - image.level[pixel + 1]));
    }
  }
}

}  // namespace

bool is_inside(const PixelEvidence& pixel, const StereoOptions& options) {
  return pixel.column >= options.min_disparity_px + pixel.winner + window_radius_px(options);
}

bool has_texture(const PixelEvidence& pixel, const StereoOptions& options) {
  return pixel.step_sum >= options.min_texture * pixel.window_pixels;
}

bool is_unsaturated(const PixelEvidence& pixel) {
  return 2 * pixel.saturated_pixels <= pixel.window_pixels;
}

bool is_in_range(const PixelEvidence& pixel, const StereoOptions& options) {
  return pixel.winner > 0 && pixel.winner + 1 < options.disparities;
}

bool is_unique(const PixelEvidence& pixel) {
  return pixel.rivals == 0;
}

bool is_consistent(const PixelEvidence& pixel, const StereoOptions& options) {
  if (!options.has_left_right_test) return true;
  const std::uint32_t difference =
      std::max(pixel.winner, pixel.right_winner) - std::min(pixel.winner, pixel.right_winner);
  return difference <= options.left_right_px;
}

bool is_beside_border(const PixelEvidence& pixel, const StereoOptions& options) {
  return static_cast<double>(pixel.column) <
         static_cast<double>(pixel.next_disparity_px) + window_radius_px(options);
}

StereoStatus classify(const PixelEvidence& pixel, const StereoOptions& options) {
  if (!is_inside(pixel, options)) return StereoStatus::border;
  const bool is_saturated = !is_unsaturated(pixel);
  if (!has_texture(pixel, options)) {
    return is_saturated ? StereoStatus::saturated : StereoStatus::no_texture;
  }
  const bool is_found = is_in_range(pixel, options) && is_unique(pixel);
  if (is_found && is_consistent(pixel, options)) return StereoStatus::valid;
  if (is_beside_border(pixel, options)) return StereoStatus::border;
  if (!is_in_range(pixel, options)) return StereoStatus::out_of_range;
  if (is_found) return StereoStatus::left_right;
  return is_saturated ? StereoStatus::saturated : StereoStatus::ambiguous;
}

std::uint32_t without_neighbours(std::uint32_t rivals, std::uint32_t winner,
                                 const StereoOptions& options, const std::int16_t* sums) {
  if (options.uniqueness_percent == 0) return 0;
  const auto is_rival = [&](std::uint32_t lane) {
    const std::int64_t best = sums[winner] + kSumOffset;
    return (sums[lane] + kSumOffset) * std::int64_t{100 - options.uniqueness_percent} <= 100 * best;
  };
  std::uint32_t neighbours = 1;  // the winner itself
  if (winner > 0 && is_rival(winner - 1)) ++neighbours;
  if (winner + 1 < options.disparities && is_rival(winner + 1)) ++neighbours;
  return rivals - neighbours;
}

double subpixel_offset(StereoSubpixel curve, double below, double middle, double above) {
  if (curve == StereoSubpixel::none) return 0.0;
  const double bend = curve == StereoSubpixel::v_shape ? std::max(below, above) - middle
                                                       : below + above - 2.0 * middle;
  return bend > 0.0 ? (below - above) / (2.0 * bend) : 0.0;
}

double corrected_offset(double offset, double a_factor) {
  return a_factor == 0.0 ? offset : offset + a_factor * sincos_turns(offset).sine;
}

double rounded_disparity(double disparity_px, std::uint32_t steps_per_px) {
  if (steps_per_px == 0) return disparity_px;
  return std::floor(disparity_px * steps_per_px + 0.5) / steps_per_px;
}

StereoMatch match_pair(const GreyImage& left, const GreyImage& right, const StereoOptions& options,
                       const StereoRun& run, CostVolume& volume) {
  require_pair(left, right, options);
  const InstructionSet set = run.instruction_set.empty()
                                 ? select_instruction_set()
                                 : find_instruction_set(run.instruction_set);
  resize_volume(left, options.disparities, volume);
  StereoMatch match = empty_match(left, options);
  const CostSource source(left, right, options, kernel_for(set));
  const WindowSums windows =
      sum_windows(left, window_radius_px(options), saturation_level(left, options), run.pool);
  const std::size_t threads = run.pool == nullptr ? 1 : run.pool->threads();
  WinnerRows rows(source, volume, windows, threads, match);
  const auto on_row = [&](std::size_t worker, std::size_t y, const std::int16_t* sums) {
    rows.finish(worker, y, sums);
  };
  ProgressCounter progress(run.progress, progress_rows(volume));
  sum_paths(source, run, volume, RowSumsFunction(on_row), progress);
  progress.finish();
  return match;
}

PixelEvidence gather_evidence(const CostVolume& volume, const StereoMatch& match,
                              const GreyImage& left, const StereoOptions& options,
                              std::size_t pixel) {
  const auto x = static_cast<std::uint32_t>(pixel % volume.width);
  const auto y = static_cast<std::uint32_t>(pixel / volume.width);
  const std::int16_t* const sums = volume.sum.data() + pixel * volume.lanes;
  const auto count = static_cast<std::ptrdiff_t>(volume.disparities);
  const auto winner = static_cast<std::uint32_t>(std::min_element(sums, sums + count) - sums);
  PixelEvidence evidence = {.column = x, .winner = winner};
  evidence.right_winner =
      right_winner(volume, std::int64_t{x} - static_cast<std::int64_t>(winner), y);
  const std::int64_t best = sums[winner] + kSumOffset;
  const auto is_rival = [&](std::int16_t sum) {
    return (sum + kSumOffset) * std::int64_t{100 - options.uniqueness_percent} <= 100 * best;
  };
  const auto rivals = static_cast<std::uint32_t>(std::count_if(sums, sums + count, is_rival));
  evidence.rivals = without_neighbours(rivals, winner, options, sums);
  evidence.window_pixels = 0;
  add_window(left, options, x, y, evidence);
  const auto row_end =
      match.disparity_px.begin() + static_cast<std::ptrdiff_t>((std::size_t{y} + 1) * volume.width);
  const auto next =
      std::find_if(match.disparity_px.begin() + static_cast<std::ptrdiff_t>(pixel + 1), row_end,
                   [](float disparity_px) { return !std::isnan(disparity_px); });
  if (next != row_end) evidence.next_disparity_px = *next;
  return evidence;
}

}  // namespace glidar::stereo
