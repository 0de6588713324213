// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/footprint.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glidar {
namespace {

constexpr std::size_t kBeamsPerTask = 128;

void require(bool holds, const char* field, double found, const char* allowed) {
  if (holds) return;
  throw Error({.where = std::string("footprint, ") + field,
               .found = number_text(found),
               .allowed = allowed,
               .remedy = ""});
}

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

/// Up as beams have it: x forward, z up (LiDAR), or z forward, y down (camera).
Eigen::Vector3d up_of(const Beams& beams) {
  const bool is_camera = std::abs(beams.boresight.z()) > 0.5;
  return is_camera ? Eigen::Vector3d(-Eigen::Vector3d::UnitY()) : Eigen::Vector3d::UnitZ();
}

/// Writes the sub-rays of one beam from `first` on.
void spread_beam(const std::vector<SubRay>& rays, const Beams& beams, std::size_t beam,
                 std::size_t first, Beams& out) {
  const Eigen::Vector3d direction = beams.directions[beam];
  const Across basis = across(direction, up_of(beams));
  Eigen::Vector3d* directions = &out.directions[first];
  for (const SubRay& ray : rays) {
    *directions++ =
        ray.shortening * (direction + ray.slope.x() * basis.x + ray.slope.y() * basis.y);
  }
  if (!out.times_ns.empty()) std::fill_n(&out.times_ns[first], rays.size(), beams.times_ns[beam]);
  if (out.origins_m.empty()) return;
  const Eigen::Vector3d origin_m =
      beams.origins_m.empty() ? Eigen::Vector3d::Zero() : beams.origins_m[beam];
  Eigen::Vector3d* origins_m = &out.origins_m[first];
  for (const SubRay& ray : rays) {
    *origins_m++ = origin_m + ray.offset_m.x() * basis.x + ray.offset_m.y() * basis.y;
  }
}

}  // namespace

void validate(const Footprint& f) {
  const auto angle = [](double x) { return x >= 0.0 && x < std::numbers::pi / 2.0; };
  const auto width = [](double x) { return x >= 0.0 && x < 1e3; };
  require(angle(f.divergence_x_rad), "divergence_x_rad", f.divergence_x_rad, "0 to pi/2");
  require(angle(f.divergence_y_rad), "divergence_y_rad", f.divergence_y_rad, "0 to pi/2");
  require(width(f.exit_x_m), "exit_x_m", f.exit_x_m, "metres from 0 to 1000");
  require(width(f.exit_y_m), "exit_y_m", f.exit_y_m, "metres from 0 to 1000");
  require(f.rings >= 1 && f.rings <= kMostRings, "rings", f.rings, "1 to 8");
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
      const Eigen::Vector2d slope(-s * f.divergence_x_rad, c * f.divergence_y_rad);
      rays.push_back({.offset_m = {c * f.exit_x_m, s * f.exit_y_m},
                      .slope = slope,
                      .share = rings[k].share / count,
                      .shortening = 1.0 / std::sqrt(1.0 + slope.squaredNorm())});
    }
  }
  return rays;
}

void spread(const std::vector<SubRay>& rays, const Beams& beams, BeamRange range, Workers& workers,
            Beams& out) {
  const std::size_t count = (range.end - range.begin) * rays.size();
  const bool has_offsets = !beams.origins_m.empty() || !rays.back().offset_m.isZero(0.0);
  out.rows = 1;
  out.cols = static_cast<std::uint32_t>(count);
  out.frame_id = beams.frame_id;
  out.boresight = beams.boresight;
  out.directions.resize(count);
  out.origins_m.resize(has_offsets ? count : 0);
  out.times_ns.resize(beams.times_ns.empty() ? 0 : count);
  workers.for_ranges(range.end - range.begin, kBeamsPerTask,
                     [&](std::size_t begin, std::size_t end) {
                       for (std::size_t k = begin; k < end; ++k) {
                         spread_beam(rays, beams, range.begin + k, k * rays.size(), out);
                       }
                     });
}

}  // namespace glidar
