// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Levels and noise of disparity against recordings of Kinect-like cameras, with the same
// estimators for both.
#include <glidar/sensor/noise/noise.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <support/data.hpp>
#include <support/parameter_name.hpp>

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace glidar {
namespace {

constexpr std::size_t kWidth = 640;
constexpr std::size_t kHeight = 480;

/// Depths in metres, 0 where there is none, from a PNG of 16 bits with so many counts a metre.
std::vector<double> read_depth(const std::filesystem::path& path, double counts_per_m) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  std::vector<std::uint16_t> counts(kWidth * kHeight);
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0) return {};
  image.format = PNG_FORMAT_LINEAR_Y;
  if (image.width != kWidth || image.height != kHeight) return {};
  if (png_image_finish_read(&image, nullptr, counts.data(), 0, nullptr) == 0) return {};
  std::vector<double> depth_m;
  for (const std::uint16_t count : counts) depth_m.push_back(count / counts_per_m);
  return depth_m;
}

/// How well the depths are K over whole numbers plus a constant: the length of the mean of
/// exp(2 pi i K / z) over the levels that occur below 3 m, where they are many counts apart.
double fit_of_levels(const std::vector<double>& levels_m, double k_m) {
  std::complex<double> sum = 0.0;
  for (const double z : levels_m) sum += std::polar(1.0, 2.0 * std::numbers::pi * k_m / z);
  return std::abs(sum) / static_cast<double>(levels_m.size());
}

/// The K that fits best; 0.02 m apart.
double fitted_k_m(const std::vector<double>& depth_m) {
  std::vector<double> levels = depth_m;
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  std::erase_if(levels, [](double z) { return z <= 0.0 || z >= 3.0; });
  double best = 0.0;
  double best_fit = 0.0;
  for (double k_m = 200.0; k_m < 420.0; k_m += 0.02) {
    const double fit = fit_of_levels(levels, k_m);
    if (fit > best_fit) best = k_m;
    best_fit = std::max(fit, best_fit);
  }
  constexpr double kClear = 0.9;  // 1: exact; rounding to millimetres takes a little
  EXPECT_GT(best_fit, kClear);
  return best;
}

/// Standard deviation in steps of disparity about a plane of inverse depth, over 9 x 9 pixels
/// around (row, col); negative where a pixel is missing or another surface begins.
double residual_steps(const std::vector<double>& depth_m, double k_m, std::size_t row,
                      std::size_t col) {
  std::array<double, 81> steps{};
  double mean = 0.0;
  double across = 0.0;
  double down = 0.0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double z = depth_m[(row + k / 9 - 4) * kWidth + col + k % 9 - 4];
    if (!(z > 0.0)) return -1.0;
    steps[k] = k_m / z;
    mean += steps[k] / 81.0;
    across += steps[k] * (static_cast<double>(k % 9) - 4.0) / 540.0;  // 9 (16 + 9 + 4 + 1) 2
    down += steps[k] * (static_cast<double>(k / 9) - 4.0) / 540.0;
  }
  double squares = 0.0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double rest = steps[k] - mean - across * (static_cast<double>(k % 9) - 4.0) -
                        down * (static_cast<double>(k / 9) - 4.0);
    constexpr double kOtherSurface = 4.0;
    if (std::abs(rest) > kOtherSurface) return -1.0;
    squares += rest * rest;
  }
  return std::sqrt(squares / 78.0);
}

/// The median over the image, from 1.6 m on: nearer objects are not flat.
double median_residual(const std::vector<double>& depth_m, double k_m) {
  std::vector<double> found;
  for (std::size_t row = 4; row + 4 < kHeight; row += 9) {
    for (std::size_t col = 4; col + 4 < kWidth; col += 9) {
      if (depth_m[row * kWidth + col] < 1.6) continue;
      const double residual = residual_steps(depth_m, k_m, row, col);
      if (residual >= 0.0) found.push_back(residual);
    }
  }
  EXPECT_GT(found.size(), 500U);
  std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2),
                   found.end());
  return found[found.size() / 2];
}

/// The simulated depths of a wall tilted away to the right, in counts.
std::vector<double> modelled(double k_m, double counts_per_m) {
  const Beams beams = make_beams(pinhole_from_fov(kWidth, kHeight, 0.75));
  Frame frame;
  resize(frame, beams.size());
  std::fill(frame.intensity.begin(), frame.intensity.end(), 1.0F);
  std::fill(frame.status.begin(), frame.status.end(), Status::hit);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const Eigen::Vector3d& d = beams.directions[i];
    frame.range_m[i] = 2.2 / (d.z() - 0.3 * d.x());
  }
  ThreadPool thread_pool(2);
  NoiseWorkspace workspace;
  apply_noise(plan_noise({KinectV1{.k_m = k_m}}, 1.0 / 30.0), beams, thread_pool, workspace, frame);
  std::vector<double> depth_m;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double z = glidar::depth_m(beams, i, frame.range_m[i]);
    depth_m.push_back(std::round(z * counts_per_m) / counts_per_m);
  }
  return depth_m;
}

struct Recording {
  const char* file;
  double counts_per_m;
  double k_m;  ///< of this camera
};

void PrintTo(const Recording& recording, std::ostream* out) {
  *out << recording.file;
}

class DepthRecording : public ::testing::TestWithParam<Recording> {};

TEST_P(DepthRecording, HasTheModelsLevelsAndNoiseOfDisparity) {
  GLIDAR_NEEDS_DATA();
  const Recording& recording = GetParam();
  const std::vector<double> recorded = read_depth(
      testing::data_folder() / "recordings/open3d/rgbd" / recording.file, recording.counts_per_m);
  ASSERT_FALSE(recorded.empty());
  const double k_m = fitted_k_m(recorded);
  EXPECT_NEAR(k_m, recording.k_m, 0.5);
  const std::vector<double> ours = modelled(k_m, 1000.0);
  EXPECT_NEAR(fitted_k_m(ours), k_m, 0.3);  // fewer levels than the recording
  const double found = median_residual(recorded, k_m);
  // much of an error that 9 x 9 pixels share goes into the plane through them
  EXPECT_NEAR(found, 0.40, 0.02);
  EXPECT_NEAR(median_residual(ours, k_m) / found, 0.9, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Cameras, DepthRecording,
                         ::testing::Values(Recording{"depth/00000.png", 1000.0, 281.0},
                                           Recording{"depth/00004.png", 1000.0, 281.0},
                                           Recording{"other_formats/TUM_depth.png", 5000.0, 342.0}),
                         testing::parameter_name<Recording>);

}  // namespace
}  // namespace glidar
