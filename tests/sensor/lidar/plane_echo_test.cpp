// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/plane_echo.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glidar {
namespace {

/// Sub-rays with equal shares of the energy: rings between quantiles of the Gaussian, at the rms
/// radius of each, where the share exp(-u) is beyond u = 2 r^2 / w^2.
std::vector<SubRay> many_rays(const Footprint& f) {
  constexpr int kRings = 100;
  constexpr int kPerRing = 100;
  const auto moment_beyond = [](double share) {  // (u + 1) exp(-u)
    return share > 0.0 ? share * (1.0 - std::log(share)) : 0.0;
  };
  std::vector<SubRay> rays;
  for (int i = 0; i < kRings; ++i) {
    const double inside = 1.0 - static_cast<double>(i) / kRings;
    const double outside = 1.0 - static_cast<double>(i + 1) / kRings;
    const double u = kRings * (moment_beyond(inside) - moment_beyond(outside));
    const double radius = 0.5 * std::sqrt(0.5 * u);  // in widths
    for (int k = 0; k < kPerRing; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.5 * (i % 2)) / kPerRing;
      const double c = radius * std::cos(angle);
      const double s = radius * std::sin(angle);
      rays.push_back({.offset_m = {c * f.exit_x_m, s * f.exit_y_m},
                      .slope = {-s * f.divergence_x_rad, c * f.divergence_y_rad},
                      .share = 1.0 / (kRings * kPerRing)});
    }
  }
  return rays;
}

/// What is measured of a plane.
struct Measured {
  double range_m = 0.0;
  double signal = 0.0;   ///< height of the peak
  double sigma_m = 0.0;  ///< width of the echo

  [[nodiscard]] Measured errors(const Measured& truth) const {
    return {std::abs(range_m - truth.range_m), std::abs(signal / truth.signal - 1.0),
            std::abs(sigma_m / truth.sigma_m - 1.0)};
  }
  void keep_larger(const Measured& other) {
    range_m = std::max(range_m, other.range_m);
    signal = std::max(signal, other.signal);
    sigma_m = std::max(sigma_m, other.sigma_m);
  }
};

/// A plane across a beam, see PlaneBatch.
struct PlaneAcrossBeam {
  double range_m = 0.0;
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();
};

/// A beam on a plane.
struct Case {
  Footprint footprint;
  PlaneAcrossBeam plane;
  double exponent = 2.0;
  double pulse_sigma_m = 0.3;
};

/// Every sub-ray meets the plane alone: its range is R (1 + t.o / R) / (1 - t.s) |(s, 1)|.
Measured sample(const Case& c, const std::vector<SubRay>& rays) {
  std::vector<double> range_m;
  std::vector<double> signal;
  double sum = 0.0;
  double moment_m = 0.0;
  for (const SubRay& ray : rays) {
    const double length = std::sqrt(1.0 + ray.slope.squaredNorm());
    const double towards = 1.0 - c.plane.tilt.dot(ray.slope);
    range_m.push_back((c.plane.range_m + c.plane.tilt.dot(ray.offset_m)) / towards * length);
    const double cosine = towards / length;  // of that of the central ray
    signal.push_back(ray.share * cosine * std::pow(c.plane.range_m / range_m.back(), c.exponent));
    sum += signal.back();
    moment_m += signal.back() * (range_m.back() - c.plane.range_m);
  }
  Measured m{.range_m = c.plane.range_m + moment_m / sum};
  double variance_m2 = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double off_m = range_m[i] - m.range_m;
    variance_m2 += signal[i] / sum * off_m * off_m;
    m.signal += signal[i] * std::exp(-0.5 * std::pow(off_m / c.pulse_sigma_m, 2.0));
  }
  m.sigma_m = std::sqrt(c.pulse_sigma_m * c.pulse_sigma_m + variance_m2);
  return m;
}

/// Batches of one plane.
PlaneBatch integrated(const Case& c) {
  PlaneBatch planes;
  planes.count = 1;
  planes.range_m[0] = c.plane.range_m;
  planes.tilt_x[0] = c.plane.tilt.x();
  planes.tilt_y[0] = c.plane.tilt.y();
  integrate_over_planes({c.footprint, c.exponent, c.pulse_sigma_m}, planes);
  return planes;
}

bool has_closed_form(const Case& c) {
  return integrated(c).has_closed_form[0];
}

Eigen::Vector2d tilt_across(const Eigen::Vector3d& direction, const Eigen::Vector3d& up,
                            const Eigen::Vector3d& normal) {
  PlaneBatch planes;
  planes.count = 1;
  planes.direction.set(0, direction);
  planes.normal.set(0, normal);
  find_tilts(up, planes);
  return {planes.tilt_x[0], planes.tilt_y[0]};
}

/// The echo of a central ray with the signal 1.
Measured echo_of(const Case& c, const PlaneBatch& planes) {
  PlaneEchoes echoes;
  find_echoes(c.pulse_sigma_m, {1.0}, planes, echoes);
  return {echoes.range_m[0], echoes.peak[0], echoes.sigma_m[0]};
}

Measured integrate(const Case& c) {
  return echo_of(c, integrated(c));
}

/// Beams of all presets and beyond, on planes at an angle of incidence, that have a closed form.
std::vector<Case> cases_at(double angle_deg) {
  std::vector<Case> cases;
  const double tangent = std::tan(angle_deg * std::numbers::pi / 180.0);
  for (const double divergence : {3e-4, 1.5e-3, 5.3e-3, 1.5e-2}) {
    for (const double stretch : {1.0, 0.4}) {
      for (const double exit_m : {0.0, 0.013}) {
        for (const double range_m : {0.7, 6.0, 60.0}) {
          for (const double exponent : {1.9, 3.99}) {
            const Footprint f{.divergence_x_rad = divergence,
                              .divergence_y_rad = stretch * divergence,
                              .exit_x_m = stretch * exit_m,
                              .exit_y_m = exit_m,
                              .rings = 1};
            const double turn = range_m + exponent;  // any
            const PlaneAcrossBeam plane{range_m,
                                        tangent * Eigen::Vector2d(std::cos(turn), std::sin(turn))};
            const Case c{f, plane, exponent};
            if (has_closed_form(c)) cases.push_back(c);
          }
        }
      }
    }
  }
  return cases;
}

TEST(PlaneEcho, IsMoreAccurateThanSevenSubRaysAtEveryAngle) {
  for (const double angle_deg : {0.0, 10.0, 25.0, 40.0, 55.0, 70.0, 80.0, 85.0, 88.0}) {
    Measured closed;
    Measured seven;
    std::size_t count = 0;
    for (const Case& c : cases_at(angle_deg)) {
      const Measured truth = sample(c, many_rays(c.footprint));
      closed.keep_larger(integrate(c).errors(truth));
      seven.keep_larger(sample(c, sample_footprint(c.footprint)).errors(truth));
      ++count;
    }
    EXPECT_GT(count, 10U) << angle_deg;
    // Measured: 1/19 to 1/120.
    EXPECT_LT(closed.range_m, 0.1 * seven.range_m) << angle_deg;
    EXPECT_LT(closed.signal, 0.1 * seven.signal) << angle_deg;
    EXPECT_LT(closed.sigma_m, 0.1 * seven.sigma_m) << angle_deg;
    EXPECT_LT(closed.range_m, 1e-6) << angle_deg;
    EXPECT_LT(closed.signal, 2e-5) << angle_deg;
    EXPECT_LT(closed.sigma_m, 2e-6) << angle_deg;
  }
}

TEST(PlaneEcho, HasGardnersWidthInSecondOrder) {
  const Footprint f{.divergence_x_rad = 2e-3,
                    .divergence_y_rad = 2e-3,
                    .exit_x_m = 0.01,
                    .exit_y_m = 0.01,
                    .rings = 1};
  const Measured echo = integrate({f, {20.0, {0.0, std::tan(1.0)}}});
  const double spread_m = std::tan(1.0) * diameter_m(f, 20.0) / 4.0;
  EXPECT_NEAR(std::sqrt(echo.sigma_m * echo.sigma_m - 0.3 * 0.3), spread_m, 1e-4 * spread_m);
}

TEST(PlaneEcho, HasNoClosedFormWhereTheBeamGrazesOrWidensThePulse) {
  const Footprint f{.divergence_x_rad = 4e-3, .divergence_y_rad = 4e-3, .rings = 1};
  const auto is_closed = [&](double range_m, double angle_deg, double pulse_sigma_m) {
    const double tangent = std::tan(angle_deg * std::numbers::pi / 180.0);
    return has_closed_form({f, {range_m, {tangent, 0.0}}, 2.0, pulse_sigma_m});
  };
  EXPECT_TRUE(is_closed(1.0, 88.5, 0.3));    // tan(angle) divergence / 4 = 0.038
  EXPECT_FALSE(is_closed(1.0, 89.0, 0.3));   // 0.057
  EXPECT_TRUE(is_closed(50.0, 55.0, 0.3));   // a standard deviation of 0.071 m
  EXPECT_FALSE(is_closed(50.0, 60.0, 0.3));  // 0.087 m, of at most 0.075 m
  EXPECT_TRUE(is_closed(50.0, 60.0, 0.4));
  const Footprint wide{.divergence_x_rad = 0.05, .divergence_y_rad = 0.05, .rings = 1};
  EXPECT_FALSE(has_closed_form({wide, {1.0, {0.0, 0.0}}}));
}

TEST(PlaneEcho, FindsThePlaneAcrossABeam) {
  const Eigen::Vector3d beam = Eigen::Vector3d(2.0, 0.5, -0.3).normalized();
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d normal = Eigen::Vector3d(-1.0, 0.4, 0.7).normalized();
  const Eigen::Vector2d tilt = tilt_across(beam, up, normal);
  const double angle = std::acos(-normal.dot(beam));
  EXPECT_NEAR(tilt.norm(), std::tan(angle), 1e-12);
  // A beam beside this one meets the plane farther away by tilt . offset.
  const Eigen::Vector3d side = beam.cross(up).normalized();
  const Eigen::Vector3d from = 0.1 * side + 0.2 * side.cross(beam);
  const double range_m = normal.dot(7.0 * beam - from) / normal.dot(beam);
  EXPECT_NEAR(range_m, 7.0 + tilt.dot(Eigen::Vector2d(0.1, 0.2)), 1e-12);
  EXPECT_EQ(tilt_across(up, up, -up), Eigen::Vector2d::Zero());
}

TEST(PlaneEcho, WeighsReflectancesByTheSubRaysThatSampleThem) {
  Case c{.footprint = {.divergence_x_rad = 3e-3,
                       .divergence_y_rad = 2e-3,
                       .exit_x_m = 0.01,
                       .exit_y_m = 0.02,
                       .rings = 1},
         .plane = {12.0, {1.5, -0.8}}};
  std::vector<SubRay> rays = sample_footprint(c.footprint);
  const std::vector<double> excess = {0.0, 0.8, -0.5, 0.1, 0.0, 2.0, -1.0};
  std::vector<PlaneBatch::Column> columns;
  for (const double of_ray : excess) columns.push_back({of_ray});
  c.pulse_sigma_m = 1e3;  // without an influence of the width
  PlaneBatch planes = integrated(c);
  add_excess(c.exponent, rays, columns, planes);
  const Measured echo = echo_of(c, planes);
  for (std::size_t k = 0; k < rays.size(); ++k) rays[k].share *= 1.0 + excess[k];
  const Measured sampled = sample(c, rays);
  EXPECT_NEAR(echo.range_m, sampled.range_m, 2e-5);
  EXPECT_NEAR(echo.signal, sampled.signal, 1e-4 * sampled.signal);
  EXPECT_GT(std::abs(echo.range_m - integrate(c).range_m), 1e-3);  // the textures matter
}

}  // namespace
}  // namespace glidar
