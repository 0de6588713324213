// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/tof/sample_images.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/tof/tof_camera.hpp>
#include <glidar/tof/tof_exposure.hpp>

#include <array>
#include <cmath>
#include <cstddef>

namespace glidar {
namespace {

constexpr std::uint32_t kWidth = 160;
constexpr std::uint32_t kHeight = 120;
constexpr double kFocal_px = 150.0;
constexpr double kDisc_m = 1.2;
constexpr double kWall_m = 3.0;
constexpr double kLitRadius_px = 92.0;
constexpr int kSubRays = 4;

/// What a ray meets: its depth and reflectance.
struct Surface {
  double depth_m;
  double reflectance;
};

bool is_within(double column, double row, double from, double to) {
  return column >= from && column < to && row >= 88.0 && row < 106.0;
}

/// At a position in pixels from the corner of the image.
Surface surface_at(double column, double row) {
  const double x = column - 0.5 * kWidth;
  const double y = row - 0.5 * kHeight;
  if (x * x + y * y < 900.0) return {kDisc_m, 0.7};
  const double depth_m = kWall_m / (1.0 - 0.8 * x / kFocal_px);
  if (is_within(column, row, 36.0, 60.0)) return {depth_m, 0.001};
  if (is_within(column, row, 84.0, 108.0)) return {depth_m, 100.0};
  return {depth_m, 0.5};
}

/// Range over depth at a position.
double range_per_depth(double column, double row) {
  const double x = (column - 0.5 * kWidth) / kFocal_px;
  const double y = (row - 0.5 * kHeight) / kFocal_px;
  return std::sqrt(1.0 + x * x + y * y);
}

TofCamera sample_camera() {
  TofCamera camera;
  camera.signal_electrons = 2e5;
  camera.ambient_electrons = 2e3;
  camera.contrast = {0.5, 0.7, 0.4};
  camera.read_noise_electrons = 50.0;
  camera.full_well_electrons = 4e5;
  camera.electrons_per_level = 100.0;
  camera.has_whole_levels = true;
  camera.decoder = kinect_v2_options();
  return camera;
}

using Steps = std::array<TofLight, 9>;

Steps light_at(const TofCamera& camera, const TofSteps& steps, std::uint32_t column,
               std::uint32_t row) {
  Steps light{};
  constexpr double kShare = 1.0 / (kSubRays * kSubRays);
  for (int i = 0; i < kSubRays * kSubRays; ++i) {
    const int across = i % kSubRays;
    const int down = i / kSubRays;
    const double u = column + (across + 0.5) / kSubRays;
    const double v = row + (down + 0.5) / kSubRays;
    const Surface surface = surface_at(u, v);
    const double range_m = surface.depth_m * range_per_depth(u, v);
    add_light(steps, range_m,
              kShare * camera.signal_electrons * surface.reflectance / (range_m * range_m), light);
    for (TofLight& step : light) {
      step.background += kShare * camera.ambient_electrons * surface.reflectance;
    }
  }
  return light;
}

void expose_pixel(const TofCamera& camera, const Steps& light, std::size_t pixel,
                  TofImages& images) {
  for (std::size_t step = 0; step < light.size(); ++step) {
    const RngKey key = {.seed = 2026,
                        .beam = static_cast<std::uint32_t>(pixel),
                        .block = static_cast<std::uint32_t>(step)};
    images.level[step * pixel_count(images) + pixel] =
        expose(camera, step / images.taps, light[step], key);
  }
}

}  // namespace

TofSample sample_tof_images() {
  const TofCamera camera = sample_camera();
  const TofSteps steps = make_tof_steps(camera);
  TofSample sample;
  sample.options = camera.decoder;
  sample.images = {kWidth, kHeight, 3, 3};
  sample.images.level.resize(std::size_t{9} * kWidth * kHeight);
  for (std::uint32_t row = 0; row < kHeight; ++row) {
    for (std::uint32_t column = 0; column < kWidth; ++column) {
      const std::size_t pixel = std::size_t{row} * kWidth + column;
      expose_pixel(camera, light_at(camera, steps, column, row), pixel, sample.images);
      const double u = column + 0.5;
      const double v = row + 0.5;
      sample.depth_per_range.push_back(static_cast<float>(1.0 / range_per_depth(u, v)));
      const double from_centre = portable_hypot(u - 0.5 * kWidth, v - 0.5 * kHeight);
      sample.is_illuminated.push_back(from_centre < kLitRadius_px ? 1 : 0);
    }
  }
  return sample;
}

}  // namespace glidar
