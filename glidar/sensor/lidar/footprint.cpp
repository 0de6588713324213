// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/footprint.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/unit_conversion.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>
#include <glidar/math/simd.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace glidar {
namespace {

constexpr std::size_t kBeamsPerSpread = 128;

/// A ring between two radii, with u = 2 r^2 / w^2: its share of a Gaussian's energy, and its mean
/// of u. The share beyond u is exp(-u), the integral of u exp(-u) is -(u + 1) exp(-u).
struct Ring {
  double share;
  double mean_u;
};

Ring ring_between(double from_u, double to_u) {
  const auto first_moment = [](double u) {
    return std::isinf(u) ? 0.0 : (u + 1.0) * portable_exp(-u);
  };
  const double share = portable_exp(-from_u) - portable_exp(-to_u);
  return {share, (first_moment(from_u) - first_moment(to_u)) / share};
}

/// Rotation of each ring relative to the previous one, in units of the spacing of its rays: the
/// golden ratio, so that no straight edge meets many rays at once.
constexpr double kTwist = 0.61803398874989485;

/// Ring 0 is the central disc.
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

/// Vectors of beams that are expanded together, component by component.
constexpr std::size_t kAtOnce = 16;
struct alignas(64) Vectors {
  std::array<double, kAtOnce> x;
  std::array<double, kAtOnce> y;
  std::array<double, kAtOnce> z;

  void set(std::size_t i, const Eigen::Vector3d& v) {
    x[i] = v.x();
    y[i] = v.y();
    z[i] = v.z();
  }
  [[nodiscard]] Eigen::Vector3d get(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Beams with two perpendicular directions each: sideways and up.
struct Crosses {
  Vectors beam;
  Vectors side;
  Vectors above;
};

/// out = scale (from + a x + b y).
GLIDAR_SIMD void tilt(const Vectors& from, const Crosses& c, const Eigen::Vector2d& ab,
                      double scale, Vectors& out) {
  const double a = ab.x();
  const double b = ab.y();
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    out.x[i] = scale * (from.x[i] + a * c.side.x[i] + b * c.above.x[i]);
    out.y[i] = scale * (from.y[i] + a * c.side.y[i] + b * c.above.y[i]);
    out.z[i] = scale * (from.z[i] + a * c.side.z[i] + b * c.above.z[i]);
  }
}

/// side = beam x up, above = side x beam. The side of a beam along `up` is NaN.
GLIDAR_SIMD void find_crosses(const Eigen::Vector3d& up, Crosses& c) {
  constexpr double kParallel = 1e-9;
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    const double x = c.beam.y[i] * up.z() - c.beam.z[i] * up.y();
    const double y = c.beam.z[i] * up.x() - c.beam.x[i] * up.z();
    const double z = c.beam.x[i] * up.y() - c.beam.y[i] * up.x();
    const double length = std::sqrt(x * x + y * y + z * z);
    const double scale = length > kParallel ? 1.0 / length : kNaN;
    c.side.x[i] = x * scale;
    c.side.y[i] = y * scale;
    c.side.z[i] = z * scale;
    c.above.x[i] = c.side.y[i] * c.beam.z[i] - c.side.z[i] * c.beam.y[i];
    c.above.y[i] = c.side.z[i] * c.beam.x[i] - c.side.x[i] * c.beam.z[i];
    c.above.z[i] = c.side.x[i] * c.beam.y[i] - c.side.y[i] * c.beam.x[i];
  }
}

void find_crosses(const Beams& beams, BeamRange range, Crosses& crosses) {
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    crosses.beam.set(i, beams.directions[std::min(range.begin + i, range.end - 1)]);
  }
  find_crosses(axes_of(beams).up, crosses);
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    if (!std::isnan(crosses.side.x[i])) continue;
    const Eigen::Vector3d beam = crosses.beam.get(i);
    const Eigen::Vector3d side = beam.unitOrthogonal();
    crosses.side.set(i, side);
    crosses.above.set(i, side.cross(beam));
  }
}

/// Expands up to kAtOnce beams; their sub-rays begin at index `first`.
void expand_some(const std::vector<SubRay>& rays, const Beams& beams, BeamRange range,
                 std::size_t first, Beams& out) {
  Crosses crosses;
  Vectors start_m{};
  Vectors tilted;
  find_crosses(beams, range, crosses);
  const std::size_t count = range.end - range.begin;
  for (std::size_t i = 0; i < count; ++i) {
    if (!beams.origins_m.empty()) start_m.set(i, beams.origins_m[range.begin + i]);
    if (out.times_ns.empty()) continue;
    std::fill_n(&out.times_ns[first + i * rays.size()], rays.size(),
                beams.times_ns[range.begin + i]);
  }
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const auto place = [&](std::size_t i) { return first + i * rays.size() + k; };
    tilt(crosses.beam, crosses, rays[k].slope, rays[k].shortening, tilted);
    for (std::size_t i = 0; i < count; ++i) out.directions[place(i)] = tilted.get(i);
    if (out.origins_m.empty()) continue;
    tilt(start_m, crosses, rays[k].offset_m, 1.0, tilted);
    for (std::size_t i = 0; i < count; ++i) out.origins_m[place(i)] = tilted.get(i);
  }
}

enum class Width : std::uint8_t { e2, fwhm };

/// The definition by which numbers of a file give the widths exactly.
Width exact_width(const Footprint& f) {
  for (const double width : {f.divergence_x_rad, f.divergence_y_rad, f.exit_x_m, f.exit_y_m}) {
    if (!find_exact_in(width, kUnitMilliradian.size)) return Width::fwhm;
  }
  return Width::e2;
}

/// One number for both, or [across, up].
void visit_pair(FieldVisitor& visitor, const FieldInfo& field, const NumberRule& rule,
                double& across, double& up) {
  std::vector<double> both = {across, up};
  visitor.numbers(field,
                  {.number = rule,
                   .min_size = 2,
                   .max_size = 2,
                   .takes_one = true,
                   .allowed = "one number, or two: [across, up]"},
                  both);
  if (!visitor.is_reading()) return;
  across = both[0];
  up = both[1];
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
  require_number(f.rings >= 1 && f.rings <= kMaxRings, "footprint, rings", f.rings, "1 to 8");
}

double diameter_m(const Footprint& f, double range_m) {
  const double x = f.divergence_x_rad * range_m;
  const double y = f.divergence_y_rad * range_m;
  return std::sqrt(std::max(f.exit_x_m * f.exit_x_m + x * x, f.exit_y_m * f.exit_y_m + y * y));
}

std::vector<SubRay> sample_footprint(const Footprint& f) {
  validate(f);
  const std::vector<Ring> rings = rings_of(f.rings);
  double outer_u = 0.0;  // second moment of all rays; that of the central one is 0
  for (unsigned k = 1; k <= f.rings; ++k) outer_u += rings[k].share * rings[k].mean_u;
  const double scale = 1.0 / outer_u;  // the whole beam's is 1

  std::vector<SubRay> rays{{.share = rings[0].share}};
  for (unsigned k = 1; k <= f.rings; ++k) {
    const unsigned count = 6 * k;
    const double radius = std::sqrt(0.5 * scale * rings[k].mean_u);  // of w
    for (unsigned j = 0; j < count; ++j) {
      const double angle = 2.0 * std::numbers::pi * (j + k * kTwist) / count;
      const double c = 0.5 * radius * portable_cos(angle);
      const double s = 0.5 * radius * portable_sin(angle);
      const Eigen::Vector2d slope(-s * f.divergence_x_rad, c * f.divergence_y_rad);
      rays.push_back({.offset_m = {c * f.exit_x_m, s * f.exit_y_m},
                      .slope = slope,
                      .share = rings[k].share / count,
                      .shortening = 1.0 / std::sqrt(1.0 + slope.squaredNorm())});
    }
  }
  return rays;
}

void expand_beams(const std::vector<SubRay>& rays, const Beams& beams, BeamRange range,
                  ThreadPool& thread_pool, Beams& out) {
  const std::size_t count = (range.end - range.begin) * rays.size();
  const bool has_offsets = !beams.origins_m.empty() || !rays.back().offset_m.isZero(0.0);
  out.rows = 1;
  out.cols = static_cast<std::uint32_t>(count);
  out.frame_id = beams.frame_id;
  out.boresight = beams.boresight;
  out.directions.resize(count);
  out.origins_m.resize(has_offsets ? count : 0);
  out.times_ns.resize(beams.times_ns.empty() ? 0 : count);
  thread_pool.parallel_for(range.end - range.begin, kBeamsPerSpread,
                           [&](std::size_t begin, std::size_t end) {
                             for (std::size_t k = begin; k < end; k += kAtOnce) {
                               const std::size_t beam = range.begin + k;
                               const std::size_t some = std::min(kAtOnce, end - k);
                               expand_some(rays, beams, {beam, beam + some}, k * rays.size(), out);
                             }
                           });
}

void describe(Footprint& f, FieldVisitor& visitor) {
  constexpr std::array<Named<Width>, 2> kNames = {{{"1/e2", Width::e2}, {"fwhm", Width::fwhm}}};
  const FieldInfo definition = {
      "width_definition",
      "definition of both widths; 1/e² is 1.699 times the full width at half maximum"};
  Width width = visitor.is_document() ? exact_width(f) : Width::e2;
  if (visitor.is_reading())
    visit_choice(visitor, definition, kNames, width);  // the unit of the rest
  const double size = kUnitMilliradian.size * (width == Width::fwhm ? kWidthPerFwhm : 1.0);
  visit_pair(
      visitor,
      {"divergence_mrad", "full angle: one number, or `[across, up]`", {"mrad", size}, kRequired},
      {0.0, 1500.0, false, "milliradians from 0 to 1500"}, f.divergence_x_rad, f.divergence_y_rad);
  visit_pair(visitor,
             {"exit_mm", "full width at the exit: one number, or `[across, up]`", {"mm", size}},
             {0.0, 1e5, false, "millimetres from 0 to 1e5"}, f.exit_x_m, f.exit_y_m);
  visit_choice(visitor, definition, kNames, width);
  visitor.whole_number({"rings", "rings of sub-rays around the middle one: 7, 19, 37 ... sub-rays"},
                       {1, kMaxRings}, f.rings);
  if (visitor.is_reading()) validate(f);
}

}  // namespace glidar
