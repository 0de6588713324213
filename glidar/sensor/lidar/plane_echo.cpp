// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/plane_echo.hpp>

#include <algorithm>
#include <array>

namespace glidar {
namespace {

/// Variance of a sub-ray's offset and slope in units of the widths at 1/e^2, which are four
/// standard deviations.
constexpr double kVariance = 1.0 / 16.0;

constexpr double kParallelToUp = 1e-9;  // sine of the angle

/// Bounds of the relative variance of the ranges, and of the mean square of the slopes.
constexpr double kMaxRangeVariance = 0.0025;
constexpr double kMaxSlopeVariance = 1e-4;

/// Bound of the variance of the ranges, of that of the pulse.
constexpr double kMaxWidening = 1.0 / 16.0;

/// Second and fourth moments of a beam on a plane. A sub-ray with the offset o and the slope s has
/// the range R (1 + a) / (1 - b) sqrt(1 + s^2) with a = tilt . o / R and b = tilt . s.
struct PlaneMoments {
  double aa;
  double bb;
  double ab;
  double spread;        ///< of (a + b)^2
  double ss;            ///< of s^2
  double ssss;          ///< of s^4
  double slope_spread;  ///< of s^2 (a + b)^2
};

/// Offsets (c exit_x, d exit_y) and slopes (-d divergence_x, c divergence_y), with independent
/// normal c and d (sample_footprint()).
PlaneMoments moments_of(const Footprint& f, const PlaneAcrossBeam& plane) {
  const Eigen::Vector2d a(plane.tilt.x() * f.exit_x_m / plane.range_m,
                          plane.tilt.y() * f.exit_y_m / plane.range_m);
  const Eigen::Vector2d b(-plane.tilt.x() * f.divergence_x_rad,
                          plane.tilt.y() * f.divergence_y_rad);
  const double xx = kVariance * f.divergence_x_rad * f.divergence_x_rad;
  const double yy = kVariance * f.divergence_y_rad * f.divergence_y_rad;
  PlaneMoments m;
  m.aa = kVariance * a.squaredNorm();
  m.bb = kVariance * b.squaredNorm();
  m.ab = kVariance * (a.x() * b.y() + a.y() * b.x());
  m.spread = m.aa + m.bb + 2.0 * m.ab;
  m.ss = xx + yy;
  m.ssss = m.ss * m.ss + 2.0 * (xx * xx + yy * yy);
  const double with_x = -kVariance * f.divergence_x_rad * (a.y() + b.x());
  const double with_y = kVariance * f.divergence_y_rad * (a.x() + b.y());
  m.slope_spread = m.ss * m.spread + 2.0 * (with_x * with_x + with_y * with_y);
  return m;
}

/// The mean of cos(incidence) / R^p, in units of the central ray's: of
/// (1 - b)^(p + 1) (1 + a)^-p (1 + s^2)^-((p + 1) / 2), up to the fourth order.
double mean_power(const PlaneMoments& m, double p) {
  const double n = p + 1.0;
  const double second = p * m.spread - m.ss;
  const double fourth =
      p * ((p - 1.0) * (p - 2.0) * m.bb * m.bb + (p + 2.0) * (p + 3.0) * m.aa * m.aa +
           2.0 * p * n * (m.aa * m.bb + 2.0 * m.ab * m.ab) +
           4.0 * m.ab * (p * (p - 1.0) * m.bb + n * (p + 2.0) * m.aa)) -
      2.0 * p * n * m.slope_spread + (n + 2.0) * m.ssss;
  return 1.0 + n * (0.5 * second + 0.125 * fourth);
}

}  // namespace

PlaneAcrossBeam plane_across(const Eigen::Vector3d& direction, const Eigen::Vector3d& up,
                             double range_m, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d sideways = direction.cross(up);  // as in expand_beams()
  const double length = sideways.norm();
  const Eigen::Vector3d side =
      length > kParallelToUp ? Eigen::Vector3d(sideways / length) : direction.unitOrthogonal();
  const double per_cosine = -1.0 / normal.dot(direction);
  return {range_m,
          per_cosine * Eigen::Vector2d(normal.dot(side), normal.dot(side.cross(direction)))};
}

bool has_closed_form(const Footprint& footprint, const PlaneAcrossBeam& plane,
                     double pulse_sigma_m) {
  const PlaneMoments m = moments_of(footprint, plane);
  const double variance_m2 = plane.range_m * plane.range_m * m.spread;
  return m.aa + m.bb <= kMaxRangeVariance && m.ss <= kMaxSlopeVariance &&
         variance_m2 <= kMaxWidening * pulse_sigma_m * pulse_sigma_m;
}

PlaneEcho integrate_over_plane(const Footprint& footprint, const PlaneAcrossBeam& plane,
                               double exponent, std::span<const SubRay> rays,
                               std::span<const double> excess) {
  const PlaneMoments m = moments_of(footprint, plane);
  std::array<double, 3> sum;  // of signal R^k, in units of the central ray's
  for (std::size_t k = 0; k < sum.size(); ++k) {
    sum[k] = mean_power(m, exponent - static_cast<double>(k));
  }
  for (std::size_t i = 0; i < excess.size(); ++i) {
    const double a = plane.tilt.dot(rays[i].offset_m) / plane.range_m;
    const double b = plane.tilt.dot(rays[i].slope);
    double part = rays[i].share * excess[i] * (1.0 - (exponent + 1.0) * b - exponent * a);
    for (double& moment : sum) {
      moment += part;
      part *= 1.0 + a + b;
    }
  }
  const double mean = sum[1] / sum[0];
  const double variance = std::max(0.0, sum[2] / sum[0] - mean * mean);
  return {.signal = sum[0],
          .range_m = plane.range_m * mean,
          .variance_m2 = plane.range_m * plane.range_m * variance};
}

}  // namespace glidar
