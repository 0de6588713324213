// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/lateral_noise.hpp>

#include <glidar/math/simd.hpp>

#include <limits>
#include <span>

namespace glidar {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The stored depth of a pixel; NaN outside the image.
double stored_depth(const NoiseView& view, double row, double col) {
  const bool inside = row >= 0.0 && col >= 0.0 && row < view.beams.rows && col < view.beams.cols;
  if (!inside) return kNone;
  const auto at = static_cast<std::size_t>(row) * view.beams.cols + static_cast<std::size_t>(col);
  return view.workspace.before[at];
}

double depth_between(const NoiseView& view, double row, double col) {
  const double top = std::floor(row);
  const double left = std::floor(col);
  const double down = row - top;
  const double right = col - left;
  const auto along = [&](double in_row) {
    const double first = stored_depth(view, in_row, left);
    if (!(right > 0.0)) return first;
    return (1.0 - right) * first + right * stored_depth(view, in_row, left + 1.0);
  };
  const double upper = along(top);
  const double lower = along(top + 1.0);
  // A neighbour of weight 0 must not contribute, even if it is outside.
  const double depth = down > 0.0 ? (1.0 - down) * upper + down * lower : upper;
  if (!std::isnan(depth)) return depth;
  return stored_depth(view, std::floor(row + 0.5), std::floor(col + 0.5));
}

/// sums[k] += values[k]
GLIDAR_SIMD void add(const double* values, std::span<double> sums) {
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += values[k];
}

/// Sums of `window` rows around a row, at the columns [first, first + sums).
std::size_t sum_rows(const NoiseView& view, std::size_t row, std::size_t reach, std::size_t first,
                     std::span<double> sums) {
  const std::size_t top = row - std::min(row, reach);
  const std::size_t end = std::min<std::size_t>(view.beams.rows, row + reach + 1);
  std::fill(sums.begin(), sums.end(), 0.0);
  for (std::size_t r = top; r < end; ++r) {
    add(view.workspace.before.data() + r * view.beams.cols + first, sums);
  }
  return end - top;
}

/// means[k] = (sums[k] + ... + sums[k + width - 1]) / divisor, added from left to right.
GLIDAR_SIMD void slide(const double* sums, std::size_t width, double divisor,
                       std::span<double> means) {
  for (std::size_t k = 0; k < means.size(); ++k) means[k] = 0.0;
  for (std::size_t c = 0; c < width; ++c) {
    for (std::size_t k = 0; k < means.size(); ++k) means[k] += sums[k + c];
  }
  for (std::size_t k = 0; k < means.size(); ++k) means[k] /= divisor;
}

}  // namespace

void store_depth(const NoiseView& view, const NoiseBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    view.workspace.before[batch.first + i] =
        batch.depth_at_zero[i] + batch.depth_per_m[i] * batch.range_m[i];
  }
}

void shift_laterally(const PairBatch& shift_px, const NoiseView& view, NoiseBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (!is_hit(batch, i)) continue;
    const std::size_t beam = batch.first + i;
    const std::size_t whole_row = beam / view.beams.cols;
    const double col = static_cast<double>(beam % view.beams.cols) + shift_px.first[i];
    const double row = static_cast<double>(whole_row) + shift_px.second[i];
    const double depth = depth_between(view, std::clamp(row, 0.0, view.beams.rows - 1.0),
                                       std::clamp(col, 0.0, view.beams.cols - 1.0));
    if (std::isnan(depth)) {
      invalidate_return(batch, i, Status::dropped);
    } else {
      batch.range_m[i] = (depth - batch.depth_at_zero[i]) / batch.depth_per_m[i];
    }
  }
}

void mean_over_window(unsigned window, const NoiseView& view, const NoiseBatch& batch,
                      Batch<double>& means) {
  const std::size_t reach = std::min<std::size_t>(window / 2, kMaxWindowReach);
  const std::size_t cols = view.beams.cols;
  std::array<double, kSampleBatch + 2 * kMaxWindowReach> sums;
  for (std::size_t i = 0; i < batch.count;) {
    // the pixels of the batch that are in one row
    const std::size_t row = (batch.first + i) / cols;
    const std::size_t begin = (batch.first + i) % cols;
    const std::size_t end = std::min(cols, begin + (batch.count - i));
    const std::size_t left = begin - std::min(begin, reach);
    const std::size_t right = std::min(cols, end + reach);
    const std::size_t height = sum_rows(view, row, reach, left, {sums.data(), right - left});
    for (std::size_t col = begin; col < end;) {
      // pixels whose windows have the same width
      const bool is_whole = col >= reach && col + reach < cols;
      const std::size_t next = is_whole ? std::min(end, cols - reach) : col + 1;
      const std::size_t from = col - std::min(col, reach);
      const std::size_t width = std::min(cols, col + reach + 1) - from;
      slide(sums.data() + (from - left), width, std::sqrt(static_cast<double>(height * width)),
            {means.data() + i, next - col});
      i += next - col;
      col = next;
    }
  }
}

}  // namespace glidar
