// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/probes.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/math/random.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include <cmath>
#include <numbers>
#include <utility>

namespace glidar {

std::array<double, 4> probe_uniforms(std::uint32_t number, std::uint32_t index) {
  const RandomWords words =
      random_words({.seed = 1, .frame = number, .beam = index, .purpose = Purpose::verification});
  return {uniform(words[0]), uniform(words[1]), uniform(words[2]), uniform(words[3])};
}

Eigen::Quaterniond random_rotation(const std::array<double, 4>& u) {
  const double a = std::sqrt(1.0 - u[0]);
  const double b = std::sqrt(u[0]);
  const double s = 2.0 * std::numbers::pi * u[1];
  const double t = 2.0 * std::numbers::pi * u[2];
  return Eigen::Quaterniond(b * portable_cos(t), a * portable_sin(s), a * portable_cos(s),
                            b * portable_sin(t))
      .normalized();
}

Eigen::Vector3d random_direction(double u0, double u1, double half_angle_rad) {
  const double z = 1.0 - u0 * (1.0 - portable_cos(half_angle_rad));
  const double r = std::sqrt(1.0 - z * z);
  const double angle = 2.0 * std::numbers::pi * u1;
  return Eigen::Vector3d(r * portable_cos(angle), r * portable_sin(angle), z).normalized();
}

Beams camera_probes(double half_view_rad) {
  constexpr std::uint32_t kImageSide = 64;
  return make_beams(pinhole_from_fov(kImageSide, kImageSide, 2.0 * half_view_rad));
}

Beams scanner_probes() {
  constexpr std::uint32_t kRows = 32;
  constexpr std::uint32_t kColumns = 1024;
  constexpr double kStep_rad = 2.0 * std::numbers::pi / kColumns;
  Beams beams;
  beams.rows = kRows;
  beams.cols = kColumns;
  beams.frame_id = "verify";
  beams.boresight = Eigen::Vector3d::UnitX();
  for (std::uint32_t row = 0; row < kRows; ++row) {
    const double part = (row + 0.5) / kRows - 0.5;
    const double elevation_rad = 0.5 * part + 1.2 * part * part * part;
    for (std::uint32_t col = 0; col < kColumns; ++col) {
      const double azimuth_rad = kStep_rad * (col + 0.25 * (row % 4));
      const Eigen::Vector3d direction(portable_cos(azimuth_rad) * portable_cos(elevation_rad),
                                      portable_sin(azimuth_rad) * portable_cos(elevation_rad),
                                      portable_sin(elevation_rad));
      beams.directions.push_back(direction.normalized());
    }
  }
  return beams;
}

Beams unstructured_probes(std::vector<Eigen::Vector3d> directions,
                          std::vector<Eigen::Vector3d> origins_m) {
  Beams beams;
  beams.rows = 1;
  beams.cols = static_cast<std::uint32_t>(directions.size());
  beams.frame_id = "verify";
  beams.directions = std::move(directions);
  beams.origins_m = std::move(origins_m);
  return beams;
}

Beams random_probes(std::uint32_t number, double half_view_rad, double spread_m) {
  constexpr std::uint32_t kRandomRays = 4096;
  std::vector<Eigen::Vector3d> directions;
  std::vector<Eigen::Vector3d> origins_m;
  for (std::uint32_t i = 0; i < kRandomRays; ++i) {
    const std::array<double, 4> u = probe_uniforms(number, 1 + i);
    directions.push_back(random_direction(u[0], u[1], half_view_rad));
    origins_m.emplace_back(spread_m * (u[2] - 0.5), spread_m * (u[3] - 0.5), 0.0);
  }
  return unstructured_probes(std::move(directions), std::move(origins_m));
}

}  // namespace glidar
