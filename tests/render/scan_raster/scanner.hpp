// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/optics/pinhole.hpp>
#include <render/renderer_suite.hpp>

#include <cstddef>

namespace glidar::testing {

/// Beams of a spinning or line scanner.
struct Scanner {
  std::uint32_t rows = 19;
  std::uint32_t cols = 360;
  double low_rad = -0.4;
  double high_rad = 0.3;
  double start_rad = 0.1;
  double span_rad = 2.0 * std::numbers::pi;  ///< below zero: clockwise
  double stagger_rad = 0.0;                  ///< azimuth from one row to another, of four
  double uneven = 0.0;                       ///< random errors of all angles, of a column's width
  double origin_m = 0.0;                     ///< maximum random coordinate of origins
};

inline Beams scanner_beams(const Scanner& s, std::uint64_t seed = 1) {
  Draws draws(seed);
  Beams beams;
  beams.rows = s.rows;
  beams.cols = s.cols;
  beams.frame_id = "lidar_frame";
  beams.boresight = Eigen::Vector3d::UnitX();
  const double step_rad = s.span_rad / s.cols;
  const auto error = [&] { return s.uneven * step_rad * (draws.next() - 0.5); };
  for (std::uint32_t row = 0; row < s.rows; ++row) {
    const double part = s.rows == 1 ? 0.5 : static_cast<double>(row) / (s.rows - 1);
    const double elevation_rad = s.high_rad + part * (s.low_rad - s.high_rad);
    for (std::uint32_t col = 0; col < s.cols; ++col) {
      const double azimuth_rad = s.start_rad + col * step_rad + s.stagger_rad * (row % 4) + error();
      const double up_rad = elevation_rad + error();
      const Eigen::Vector3d direction(std::cos(azimuth_rad) * std::cos(up_rad),
                                      std::sin(azimuth_rad) * std::cos(up_rad), std::sin(up_rad));
      beams.directions.push_back(direction.normalized());
      if (s.origin_m == 0.0) continue;
      beams.origins_m.push_back(
          2.0 * s.origin_m *
          Eigen::Vector3d(draws.next() - 0.5, draws.next() - 0.5, draws.next() - 0.5));
    }
  }
  return beams;
}

/// A camera with this lens, whose principal point is beside the image centre.
Beams lens_beams(std::uint32_t width, std::uint32_t height, double focal_px,
                 const Distortion& distortion);

Beams preset_beams(const char* name);

inline Hits cast_with(const char* kind, const Scene& scene, const CastRequest& request) {
  Hits hits;
  make_renderer(scene, {.kind = kind, .threads = 2})->cast(request, hits);
  return hits;
}

/// Expects the same bits of every column; returns how many beams hit.
std::size_t expect_same_hits(const Hits& found, const Hits& expected);

/// The raster and the rays of a scene, made once for many casts.
class RasterAndRays {
 public:
  explicit RasterAndRays(const Scene& scene);

  /// Expects the same bits from both; returns how many beams hit.
  std::size_t expect_same(const CastRequest& request) const;
  std::size_t expect_same(const Beams& beams, const Pose& world_from_sensor) const;

 private:
  std::unique_ptr<Renderer> raster_;
  std::unique_ptr<Renderer> rays_;
};

/// The same for a single cast.
std::size_t expect_same_as_rays(const Scene& scene, const CastRequest& request);
std::size_t expect_same_as_rays(const Scene& scene, const Beams& beams,
                                const Pose& world_from_sensor);

}  // namespace glidar::testing
