// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/footprint.hpp>

#include <glidar/core/error.hpp>

#include <cmath>
#include <limits>
#include <numbers>

namespace glidar {
namespace {

/// What lies between two radii, as u = 2 r^2 / w^2: the share of a Gaussian's energy, and its mean
/// of u. The share beyond u is exp(-u), the integral of u exp(-u) is -(u + 1) exp(-u).
struct Ring {
  double share;
  double mean_u;
};

Ring ring_between(double from_u, double to_u) {
  const auto first_moment = [](double u) { return std::isinf(u) ? 0.0 : (u + 1.0) * std::exp(-u); };
  const double share = std::exp(-from_u) - std::exp(-to_u);
  return {share, (first_moment(from_u) - first_moment(to_u)) / share};
}

/// Turns each ring against the one inside by this part of its rays' spacing, the golden ratio's, so
/// that no straight edge meets many rays at once.
constexpr double kTwist = 0.61803398874989485;

/// Ring 0 is the disc in the middle.
std::vector<Ring> rings_of(unsigned count) {
  const double step = count == 1 ? 0.5 : 1.0 / count;  // of w
  const auto u_of = [](double radius) { return 2.0 * radius * radius; };
  std::vector<Ring> rings;
  for (unsigned k = 0; k <= count; ++k) {
    const double end = k == count ? std::numeric_limits<double>::infinity() : u_of((k + 1) * step);
    rings.push_back(ring_between(u_of(k * step), end));
  }
  return rings;
}

/// Two directions across a beam: to its side and up.
struct Across {
  Eigen::Vector3d x;
  Eigen::Vector3d y;
};

Across across(const Eigen::Vector3d& direction, const Eigen::Vector3d& up) {
  constexpr double kParallel = 1e-9;
  const Eigen::Vector3d side = direction.cross(up);
  const Eigen::Vector3d x =
      side.norm() > kParallel ? Eigen::Vector3d(side.normalized()) : direction.unitOrthogonal();
  return {x, x.cross(direction)};
}

/// Where a sub-ray of a beam starts.
Eigen::Vector3d origin_of(const Beams& beams, std::size_t beam, const SubRay& ray,
                          const Across& basis) {
  const Eigen::Vector3d offset = ray.offset_m.x() * basis.x + ray.offset_m.y() * basis.y;
  return beams.origins_m.empty() ? offset : Eigen::Vector3d(offset + beams.origins_m[beam]);
}

}  // namespace

void validate(const Footprint& f) {
  const auto angle = [](double x) { return x >= 0.0 && x < std::numbers::pi / 2.0; };
  const auto width = [](double x) { return x >= 0.0 && x < 1e3; };
  require_number(angle(f.divergence_x_rad), "footprint, divergence_x_rad", f.divergence_x_rad,
                 "0 to pi/2");
  require_number(angle(f.divergence_y_rad), "footprint, divergence_y_rad", f.divergence_y_rad,
                 "0 to pi/2");
  require_number(width(f.exit_x_m), "footprint, exit_x_m", f.exit_x_m, "metres from 0 to 1000");
  require_number(width(f.exit_y_m), "footprint, exit_y_m", f.exit_y_m, "metres from 0 to 1000");
  require_number(f.rings >= 1 && f.rings <= kMostRings, "footprint, rings", f.rings, "1 to 8");
}

double diameter_m(const Footprint& f, double range_m) {
  const double x = f.divergence_x_rad * range_m;
  const double y = f.divergence_y_rad * range_m;
  return std::sqrt(std::max(f.exit_x_m * f.exit_x_m + x * x, f.exit_y_m * f.exit_y_m + y * y));
}

std::vector<SubRay> sub_rays(const Footprint& f) {
  validate(f);
  const std::vector<Ring> rings = rings_of(f.rings);
  double outer_u = 0.0;  // second moment of all but the middle ray, which has none
  for (unsigned k = 1; k <= f.rings; ++k) outer_u += rings[k].share * rings[k].mean_u;
  const double scale = 1.0 / outer_u;  // the whole beam's is 1

  std::vector<SubRay> rays{{.share = rings[0].share}};
  for (unsigned k = 1; k <= f.rings; ++k) {
    const unsigned count = 6 * k;
    const double radius = std::sqrt(0.5 * scale * rings[k].mean_u);  // of w
    for (unsigned j = 0; j < count; ++j) {
      const double angle = 2.0 * std::numbers::pi * (j + k * kTwist) / count;
      const double c = 0.5 * radius * std::cos(angle);
      const double s = 0.5 * radius * std::sin(angle);
      rays.push_back({.offset_m = {c * f.exit_x_m, s * f.exit_y_m},
                      .slope = {-s * f.divergence_x_rad, c * f.divergence_y_rad},
                      .share = rings[k].share / count});
    }
  }
  return rays;
}

void spread(const std::vector<SubRay>& rays, const Beams& beams, BeamRange range, Beams& out) {
  const std::size_t count = (range.end - range.begin) * rays.size();
  const bool has_offsets = !beams.origins_m.empty() || !rays.back().offset_m.isZero(0.0);
  out.rows = 1;
  out.cols = static_cast<std::uint32_t>(count);
  out.frame_id = beams.frame_id;
  out.boresight = beams.boresight;
  out.directions.resize(count);
  out.origins_m.resize(has_offsets ? count : 0);
  out.times_ns.resize(beams.times_ns.empty() ? 0 : count);
  const Eigen::Vector3d up = axes_of(beams).up;
  std::size_t i = 0;
  for (std::size_t beam = range.begin; beam < range.end; ++beam) {
    const Eigen::Vector3d& direction = beams.directions[beam];
    const Across basis = across(direction, up);
    for (const SubRay& ray : rays) {
      const double length = std::sqrt(1.0 + ray.slope.squaredNorm());
      out.directions[i] = (direction + ray.slope.x() * basis.x + ray.slope.y() * basis.y) / length;
      if (has_offsets) out.origins_m[i] = origin_of(beams, beam, ray, basis);
      if (!out.times_ns.empty()) out.times_ns[i] = beams.times_ns[beam];
      ++i;
    }
  }
}

}  // namespace glidar
