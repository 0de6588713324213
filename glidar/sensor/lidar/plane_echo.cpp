// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/plane_echo.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/simd.hpp>

#include <algorithm>
#include <cmath>

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
struct BeamMoments {
  double aa;
  double bb;
  double ab;
  double spread;        ///< of (a + b)^2
  double ss;            ///< of s^2
  double ssss;          ///< of s^4
  double slope_spread;  ///< of s^2 (a + b)^2
};

/// A beam with the width of a footprint on a plane.
struct BeamOnPlane {
  double range_m;
  double tilt_x;
  double tilt_y;
};

/// Offsets (c exit_x, d exit_y) and slopes (-d divergence_x, c divergence_y), with independent
/// normal c and d (sample_footprint()).
inline BeamMoments moments_of(const Footprint& f, const BeamOnPlane& plane) {
  const double a_x = plane.tilt_x * f.exit_x_m / plane.range_m;
  const double a_y = plane.tilt_y * f.exit_y_m / plane.range_m;
  const double b_x = -plane.tilt_x * f.divergence_x_rad;
  const double b_y = plane.tilt_y * f.divergence_y_rad;
  const double xx = kVariance * f.divergence_x_rad * f.divergence_x_rad;
  const double yy = kVariance * f.divergence_y_rad * f.divergence_y_rad;
  BeamMoments m;
  m.aa = kVariance * (a_x * a_x + a_y * a_y);
  m.bb = kVariance * (b_x * b_x + b_y * b_y);
  m.ab = kVariance * (a_x * b_y + a_y * b_x);
  m.spread = m.aa + m.bb + 2.0 * m.ab;
  m.ss = xx + yy;
  m.ssss = m.ss * m.ss + 2.0 * (xx * xx + yy * yy);
  const double with_x = -kVariance * f.divergence_x_rad * (a_y + b_x);
  const double with_y = kVariance * f.divergence_y_rad * (a_x + b_y);
  m.slope_spread = m.ss * m.spread + 2.0 * (with_x * with_x + with_y * with_y);
  return m;
}

/// The mean of cos(incidence) / R^p, in units of the central ray's: of
/// (1 - b)^(p + 1) (1 + a)^-p (1 + s^2)^-((p + 1) / 2), up to the fourth order.
inline double mean_power(const BeamMoments& m, double p) {
  const double n = p + 1.0;
  const double second = p * m.spread - m.ss;
  const double fourth =
      p * ((p - 1.0) * (p - 2.0) * m.bb * m.bb + (p + 2.0) * (p + 3.0) * m.aa * m.aa +
           2.0 * p * n * (m.aa * m.bb + 2.0 * m.ab * m.ab) +
           4.0 * m.ab * (p * (p - 1.0) * m.bb + n * (p + 2.0) * m.aa)) -
      2.0 * p * n * m.slope_spread + (n + 2.0) * m.ssss;
  return 1.0 + n * (0.5 * second + 0.125 * fourth);
}

/// As find_crosses() of footprints: the side of a beam along `up` is NaN.
GLIDAR_SIMD void find_sides(const Eigen::Vector3d& up, const PlaneBatch& planes,
                            PlaneBatch::Columns3& side) {
  const double up_x = up.x();
  const double up_y = up.y();
  const double up_z = up.z();
  const PlaneBatch::Columns3& d = planes.direction;
  for (std::size_t i = 0; i < planes.count; ++i) {
    const double x = d.y[i] * up_z - d.z[i] * up_y;
    const double y = d.z[i] * up_x - d.x[i] * up_z;
    const double z = d.x[i] * up_y - d.y[i] * up_x;
    const double length = std::sqrt(x * x + y * y + z * z);
    const double divisor = length > kParallelToUp ? length : kNaN;
    side.x[i] = x / divisor;
    side.y[i] = y / divisor;
    side.z[i] = z / divisor;
  }
}

GLIDAR_SIMD void find_tilts_along(const PlaneBatch::Columns3& side, PlaneBatch& planes) {
  const PlaneBatch::Columns3& d = planes.direction;
  const PlaneBatch::Columns3& n = planes.normal;
  for (std::size_t i = 0; i < planes.count; ++i) {
    const double x = side.y[i] * d.z[i] - side.z[i] * d.y[i];
    const double y = side.z[i] * d.x[i] - side.x[i] * d.z[i];
    const double z = side.x[i] * d.y[i] - side.y[i] * d.x[i];
    const double per_cosine = -1.0 / (n.x[i] * d.x[i] + n.y[i] * d.y[i] + n.z[i] * d.z[i]);
    planes.tilt_x[i] = per_cosine * (n.x[i] * side.x[i] + n.y[i] * side.y[i] + n.z[i] * side.z[i]);
    planes.tilt_y[i] = per_cosine * (n.x[i] * x + n.y[i] * y + n.z[i] * z);
  }
}

}  // namespace

void find_tilts(const Eigen::Vector3d& up, PlaneBatch& planes) {
  PlaneBatch::Columns3 side;
  find_sides(up, planes, side);
  for (std::size_t i = 0; i < planes.count; ++i) {
    if (!std::isnan(side.x[i])) continue;
    const PlaneBatch::Columns3& d = planes.direction;
    side.set(i, Eigen::Vector3d(d.x[i], d.y[i], d.z[i]).unitOrthogonal());
  }
  find_tilts_along(side, planes);
}

GLIDAR_SIMD void integrate_over_planes(const PlanePulse& pulse, PlaneBatch& planes) {
  const Footprint f = pulse.footprint;  // copies, so that the loop vectorises
  const double exponent = pulse.exponent;
  const double max_variance_m2 = kMaxWidening * pulse.pulse_sigma_m * pulse.pulse_sigma_m;
  for (std::size_t i = 0; i < planes.count; ++i) {
    const double range_m = planes.range_m[i];
    const BeamMoments m = moments_of(f, {range_m, planes.tilt_x[i], planes.tilt_y[i]});
    const double variance_m2 = range_m * range_m * m.spread;
    planes.has_closed_form[i] = (m.aa + m.bb <= kMaxRangeVariance) & (m.ss <= kMaxSlopeVariance) &
                                (variance_m2 <= max_variance_m2);
    planes.moment[0][i] = mean_power(m, exponent);
    planes.moment[1][i] = mean_power(m, exponent - 1.0);
    planes.moment[2][i] = mean_power(m, exponent - 2.0);
  }
}

PlaneMoments moments_of(const PlaneBatch& planes, std::size_t i) {
  return {.range_m = planes.range_m[i],
          .tilt_x = planes.tilt_x[i],
          .tilt_y = planes.tilt_y[i],
          .moment = {planes.moment[0][i], planes.moment[1][i], planes.moment[2][i]}};
}

void set_moments(const PlaneMoments& moments, std::size_t i, PlaneBatch& planes) {
  planes.range_m[i] = moments.range_m;
  planes.tilt_x[i] = moments.tilt_x;
  planes.tilt_y[i] = moments.tilt_y;
  for (std::size_t k = 0; k < 3; ++k) planes.moment[k][i] = moments.moment[k];
}

GLIDAR_SIMD void add_excess(double exponent, std::span<const SubRay> rays,
                            std::span<const PlaneBatch::Column> excess, PlaneBatch& planes) {
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const double share = rays[k].share;
    const double offset_x = rays[k].offset_m.x();
    const double offset_y = rays[k].offset_m.y();
    const double slope_x = rays[k].slope.x();
    const double slope_y = rays[k].slope.y();
    const double* const of_ray = excess[k].data();
    for (std::size_t i = 0; i < planes.count; ++i) {
      const double x = planes.tilt_x[i];
      const double y = planes.tilt_y[i];
      const double a = (x * offset_x + y * offset_y) / planes.range_m[i];
      const double b = x * slope_x + y * slope_y;
      const double part = share * of_ray[i] * (1.0 - (exponent + 1.0) * b - exponent * a);
      const double farther = 1.0 + a + b;
      planes.moment[0][i] += part;
      planes.moment[1][i] += part * farther;
      planes.moment[2][i] += part * farther * farther;
    }
  }
}

GLIDAR_SIMD void find_echoes(double pulse_sigma_m, const PlaneBatch::Column& signal,
                             const PlaneBatch& planes, PlaneEchoes& echoes) {
  const double pulse_m2 = pulse_sigma_m * pulse_sigma_m;
  for (std::size_t i = 0; i < planes.count; ++i) {
    const double range_m = planes.range_m[i];
    const double mean = planes.moment[1][i] / planes.moment[0][i];
    const double variance = planes.moment[2][i] / planes.moment[0][i] - mean * mean;
    const double width_m2 = pulse_m2 + range_m * range_m * (variance > 0.0 ? variance : 0.0);
    const double sum = signal[i] * planes.moment[0][i];
    echoes.range_m[i] = range_m * mean;
    echoes.signal[i] = sum;
    echoes.peak[i] = sum * std::sqrt(pulse_m2 / width_m2);
    echoes.sigma_m[i] = std::sqrt(width_m2);
  }
}

}  // namespace glidar
