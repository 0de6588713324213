// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/tof_bounce_filter.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

/// The surface that a pixel's beam hits.
struct PixelSurface {
  Eigen::Vector3d point_m;
  Eigen::Vector3d normal;
  double range_m;
};

PixelSurface surface_of(const Simulation& s, std::size_t pixel) {
  const Hits& truth = s.frame.ground_truth;
  const double range_m = truth.range_m[pixel];
  return {range_m * s.beams.directions[pixel], truth.normal[pixel].cast<double>(), range_m};
}

/// Whether both pixels see one surface without much curvature. False for misses.
bool is_same_surface(const PixelSurface& a, const PixelSurface& b) {
  constexpr double kMinCosine = 0.966;        // 15 degrees
  constexpr double kMaxPlaneDistance = 0.01;  // of the range
  return a.normal.dot(b.normal) >= kMinCosine &&
         std::abs(a.normal.dot(b.point_m - a.point_m)) <= kMaxPlaneDistance * a.range_m;
}

/// Rows and columns around a pixel, within the image.
struct Square {
  std::size_t first_row;
  std::size_t end_row;
  std::size_t first_column;
  std::size_t end_column;
};

Square square_around(const Simulation& s, std::size_t pixel, std::size_t radius) {
  const std::size_t row = pixel / s.beams.cols;
  const std::size_t column = pixel % s.beams.cols;
  return {row - std::min(row, radius), std::min(row + radius + 1, std::size_t{s.beams.rows}),
          column - std::min(column, radius),
          std::min(column + radius + 1, std::size_t{s.beams.cols})};
}

/// Adds the light of the exposure's steps, multiplied by `scale`.
void add_scaled(const TofExposure& exposure, double scale, const TofLight* from, TofLight* to) {
  for (std::size_t i = exposure.first; i < exposure.end; ++i) {
    to[i].signal += scale * from[i].signal;
    to[i].correlated += scale * from[i].correlated;
  }
}

void add_pixel(const Simulation& s, const PreparedTof& prepared, const TofExposure& exposure,
               std::size_t pixel, std::vector<TofLight>& sum) {
  TofWorkspace& memory = s.workspace.tof;
  const std::size_t steps = step_count(prepared);
  const PixelSurface own = surface_of(s, pixel);
  const Square square = square_around(s, pixel, prepared.camera.bounce_filter_px);
  sum.assign(steps, {});
  double reflectance = 0.0;
  for (std::size_t row = square.first_row; row < square.end_row; ++row) {
    for (std::size_t column = square.first_column; column < square.end_column; ++column) {
      const std::size_t other = row * s.beams.cols + column;
      if (other != pixel && !is_same_surface(own, surface_of(s, other))) continue;
      reflectance += memory.reflectance[other];
      add_scaled(exposure, 1.0, &memory.bounced_light[other * steps], sum.data());
    }
  }
  if (!(reflectance > 0.0)) return;
  const double scale = memory.reflectance[pixel] / reflectance;
  add_scaled(exposure, scale, sum.data(), &memory.light[pixel * steps]);
  if (exposure.first == 0) memory.bounced[pixel] = static_cast<float>(scale * sum[0].signal);
}

}  // namespace

void add_filtered_bounces(const Simulation& s, const PreparedTof& prepared,
                          const TofExposure& exposure) {
  s.renderer.thread_pool().parallel_for(s.beams.rows, 1, [&](std::size_t begin, std::size_t end) {
    std::vector<TofLight> sum;
    for (std::size_t i = begin * s.beams.cols; i < end * s.beams.cols; ++i) {
      add_pixel(s, prepared, exposure, i, sum);
    }
  });
}

}  // namespace glidar
