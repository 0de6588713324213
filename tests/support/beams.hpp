// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/random.hpp>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace glidar::testing {

/// Draws for test rays: always the same.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : draw_{.seed = seed} {}
  double next() {
    if (used_ == 4) {
      ++draw_.block;
      used_ = 0;
    }
    if (used_ == 0) words_ = random_words(draw_);
    return uniform(words_[used_++]);
  }
  Eigen::Vector3d direction() {
    const double z = 2.0 * next() - 1.0;
    const double angle = 2.0 * std::numbers::pi * next();
    const double radius = std::sqrt(1.0 - z * z);
    return Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), z).normalized();
  }

 private:
  Draw draw_;
  RandomWords words_{};
  unsigned used_ = 0;
};

/// Beams of no pattern.
inline Beams loose_beams(std::vector<Eigen::Vector3d> directions,
                         std::vector<Eigen::Vector3d> origins) {
  Beams beams;
  beams.rows = 1;
  beams.cols = static_cast<std::uint32_t>(directions.size());
  beams.frame_id = "test";
  beams.directions = std::move(directions);
  beams.origins_m = std::move(origins);
  return beams;
}

/// A pinhole camera with the principal point in the middle.
inline Beams camera_beams(std::uint32_t width, std::uint32_t height, double focal_px) {
  Beams beams;
  beams.rows = height;
  beams.cols = width;
  beams.frame_id = "camera_optical_frame";
  for (std::uint32_t v = 0; v < height; ++v) {
    for (std::uint32_t u = 0; u < width; ++u) {
      beams.directions.push_back(Eigen::Vector3d((u + 0.5 - 0.5 * width) / focal_px,
                                                 (v + 0.5 - 0.5 * height) / focal_px, 1.0)
                                     .normalized());
    }
  }
  return beams;
}

}  // namespace glidar::testing
