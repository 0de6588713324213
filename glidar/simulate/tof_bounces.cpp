// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/tof_bounces.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/lidar/surface_reflectance.hpp>
#include <glidar/sensor/optics/sub_pixels.hpp>
#include <glidar/simulate/projector_occlusion.hpp>
#include <glidar/simulate/tof_bounce_filter.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace glidar {
namespace {

constexpr std::size_t kPathsPerBlock = std::size_t{1} << 18U;
constexpr std::size_t kPathPixelsPerTask = 64;
constexpr HitColumnMask kBounceColumns = {.shading_normal = true, .diffuse = true};

/// Pixels whose paths are traced together.
struct PixelBlock {
  std::size_t begin;
  std::size_t end;
};

/// Where a bounce ray starts: just before the surface, so that it does not hit it again.
Eigen::Vector3d point_before(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction,
                             double range_m) {
  constexpr double kClear = 1e-7;  // relative; far above rounding, far below any phase
  return origin_m + (range_m - kClear * std::max(1.0, range_m)) * direction;
}

/// A direction with the density cosine / pi about a unit normal: a point on the unit disc, moved to
/// the hemisphere (Malley's method: Pharr, Jakob and Humphreys, Physically Based
/// Rendering, 13.6.3).
Eigen::Vector3d cosine_direction(const Eigen::Vector3d& normal, const std::array<double, 2>& u) {
  const double radius = std::sqrt(u[0]);
  const SineCosine angle = sincos_turns(u[1]);
  const Eigen::Vector3d helper =
      std::abs(normal.x()) < 0.5 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d side = normal.cross(helper).normalized();
  const Eigen::Vector3d up = normal.cross(side);
  return (radius * angle.cosine * side + radius * angle.sine * up +
          std::sqrt(std::max(0.0, 1.0 - u[0])) * normal)
      .normalized();
}

double fraction(double value) {
  return value - std::floor(value);
}

RngKey path_key(const Simulation& s, std::size_t pixel, std::size_t block) {
  RngKey key = rng_key(s.frame, Purpose::tof_bounces, pixel);
  key.block = static_cast<std::uint32_t>(block);
  return key;
}

/// The place of a pixel in its tile, of the size of the squares that average bounced light.
std::size_t place_in_tile(const Simulation& s, const PreparedTof& prepared, std::size_t pixel) {
  const std::size_t side = 2 * std::size_t{prepared.camera.bounce_filter_px} + 1;
  return pixel / s.beams.cols % side * side + pixel % s.beams.cols % side;
}

/// The numbers that select the direction of a path's bounce. Those of first bounces are a lattice
/// that covers the square evenly (Roberts, R2 sequence: multiples of 1/p and 1/p^2, p^3 = p + 1),
/// displaced at random in each frame; without an average over pixels, in each pixel. A pixel has
/// consecutive points of it, and so has every square of the size of a tile. The numbers of further
/// bounces are independent.
std::array<double, 2> direction_numbers(const Simulation& s, const PreparedTof& prepared,
                                        std::size_t pixel, std::size_t path, std::size_t bounce) {
  const std::size_t paths = prepared.camera.bounce_rays;
  if (bounce > 0) {
    const RandomWords words = random_words(path_key(s, pixel, bounce * paths + path));
    return {uniform(words[0]), uniform(words[1])};
  }
  constexpr std::array<double, 2> kLattice = {0.7548776662466927, 0.5698402909980532};
  const bool is_averaged = prepared.camera.bounce_filter_px > 0;
  const RandomWords words = random_words(path_key(s, is_averaged ? 0 : pixel, 0));
  const auto index = static_cast<double>(place_in_tile(s, prepared, pixel) * paths + path);
  return {fraction(uniform(words[0]) + index * kLattice[0]),
          fraction(uniform(words[1]) + index * kLattice[1])};
}

/// The ray of the pixel at whose hit a path starts: all rays have equally many paths.
std::size_t first_ray(const Simulation& s, const PreparedTof& prepared, std::size_t pixel,
                      std::size_t path) {
  const std::size_t n = prepared.camera.sub_rays;
  const auto rays = static_cast<double>(n * n);
  const double offset = uniform(random_words(path_key(s, pixel, 0))[2]);
  const double place = (static_cast<double>(path) + offset) * rays /
                       static_cast<double>(prepared.camera.bounce_rays);
  const auto chosen = std::min(static_cast<std::size_t>(place), n * n - 1);
  return ray_of_pixel(s.beams.cols, n, pixel, chosen);
}

TofPath start_path(const Simulation& s, const PreparedTof& prepared, SurfaceReflectance& surfaces,
                   std::size_t ray) {
  const Hits& hits = s.workspace.tof.hits;
  if (hits.instance[ray] == kInvalidId) return {};
  const HitSurface surface = surfaces.at(hits, ray);
  const double reflectance = std::min(1.0, surface.reflectance) * double{surface.opacity};
  return {.point_m = point_before(Eigen::Vector3d::Zero(), prepared.rays.directions[ray],
                                  hits.range_m[ray]),
          .normal = hits.shading_normal[ray].cast<double>().normalized(),
          .length_m = hits.range_m[ray],
          .electrons = prepared.camera.signal_electrons * reflectance /
                       static_cast<double>(prepared.camera.bounce_rays)};
}

/// Calls body(pixel, path's index in its pixel, index in the block) for all paths of a block.
template <class Body>
void for_each_path(const Simulation& s, const PreparedTof& prepared, const PixelBlock& block,
                   const Body& body) {
  const std::size_t paths = prepared.camera.bounce_rays;
  s.renderer.thread_pool().parallel_for(
      block.end - block.begin, kPathPixelsPerTask, [&](std::size_t begin, std::size_t end) {
        SurfaceReflectance surfaces(s.scene, prepared.wavelength_m);
        for (std::size_t i = begin * paths; i < end * paths; ++i) {
          body(surfaces, block.begin + i / paths, i);
        }
      });
}

void size_rays(const Simulation& s, const TofExposure& exposure, std::size_t count, Beams& rays) {
  rays.rows = 1;
  rays.cols = static_cast<std::uint32_t>(count);
  rays.boresight = s.beams.boresight;
  rays.directions.resize(count);
  rays.times_ns.assign(s.is_moving ? count : 0, exposure.time_ns);
}

void cast_once(const Simulation& s, const Beams& rays, const HitColumnMask& columns, Hits& hits) {
  CastRequest request = cast_request(s, rays, columns);
  cast(s, request, hits);
}

void start_paths(const Simulation& s, const PreparedTof& prepared, const PixelBlock& block) {
  TofWorkspace& memory = s.workspace.tof;
  const std::size_t paths = prepared.camera.bounce_rays;
  memory.paths.resize((block.end - block.begin) * paths);
  for_each_path(s, prepared, block,
                [&](SurfaceReflectance& surfaces, std::size_t pixel, std::size_t i) {
                  memory.paths[i] =
                      start_path(s, prepared, surfaces, first_ray(s, prepared, pixel, i % paths));
                });
}

/// Casts the rays from the ends of all paths to their next surfaces.
void cast_bounce_rays(const Simulation& s, const PreparedTof& prepared, const PixelBlock& block,
                      const TofExposure& exposure, std::size_t bounce) {
  TofWorkspace& memory = s.workspace.tof;
  Beams& rays = memory.bounce_rays;
  size_rays(s, exposure, memory.paths.size(), rays);
  rays.origins_m.resize(rays.size());
  for_each_path(s, prepared, block, [&](SurfaceReflectance&, std::size_t pixel, std::size_t i) {
    const TofPath& path = memory.paths[i];
    rays.origins_m[i] = path.point_m;
    rays.directions[i].setConstant(kNaN);
    if (path.electrons == 0.0) return;
    rays.directions[i] = cosine_direction(
        path.normal,
        direction_numbers(s, prepared, pixel, i % prepared.camera.bounce_rays, bounce));
  });
  cast_once(s, rays, kBounceColumns, memory.bounce_hits);
}

/// Moves the ends of the paths to the surfaces that their rays hit, and casts illuminator rays to
/// them.
void cast_illuminator_rays(const Simulation& s, const PreparedTof& prepared,
                           const PixelBlock& block, const TofExposure& exposure) {
  TofWorkspace& memory = s.workspace.tof;
  const Hits& hits = memory.bounce_hits;
  Beams& rays = memory.illuminator_rays;
  size_rays(s, exposure, memory.paths.size(), rays);
  for_each_path(s, prepared, block, [&](SurfaceReflectance& surfaces, std::size_t, std::size_t i) {
    TofPath& path = memory.paths[i];
    rays.directions[i].setConstant(kNaN);
    if (path.electrons == 0.0) return;
    if (hits.instance[i] == kInvalidId) {
      path.electrons = 0.0;
      return;
    }
    const HitSurface surface = surfaces.at(hits, i);
    path.point_m = point_before(path.point_m, memory.bounce_rays.directions[i], hits.range_m[i]);
    path.normal = hits.shading_normal[i].cast<double>().normalized();
    path.length_m += hits.range_m[i];
    path.electrons *= std::min(1.0, surface.reflectance) * double{surface.opacity};
    if (path.normal.dot(path.point_m) < 0.0) rays.directions[i] = path.point_m.normalized();
  });
  cast_once(s, rays, {}, memory.illuminator_hits);
}

/// Adds the light of the illuminator on the ends of the paths.
void add_lit_ends(const Simulation& s, const PreparedTof& prepared, const PixelBlock& block,
                  const TofExposure& exposure) {
  TofWorkspace& memory = s.workspace.tof;
  const std::size_t steps = step_count(prepared);
  for_each_path(s, prepared, block, [&](SurfaceReflectance&, std::size_t pixel, std::size_t i) {
    const TofPath& path = memory.paths[i];
    const Eigen::Vector3d& direction = memory.illuminator_rays.directions[i];
    if (path.electrons == 0.0 || std::isnan(direction.x())) return;
    const double illuminator_m = path.point_m.norm();
    if (memory.illuminator_hits.range_m[i] < (1.0 - kShadowEpsilon) * illuminator_m) return;
    const double cosine = -path.normal.dot(direction);
    const double electrons = path.electrons * cosine / (illuminator_m * illuminator_m);
    add_light(prepared.steps, exposure, {.signal = electrons},
              0.5 * (path.length_m + illuminator_m), {&memory.bounced_light[pixel * steps], steps});
  });
}

}  // namespace

void add_bounces(const Simulation& s, const PreparedTof& prepared, const TofExposure& exposure) {
  s.workspace.tof.bounced_light.assign(s.beams.size() * step_count(prepared), {});
  const std::size_t step = std::max<std::size_t>(1, kPathsPerBlock / prepared.camera.bounce_rays);
  for (std::size_t begin = 0; begin < s.beams.size(); begin += step) {
    const PixelBlock block{begin, std::min(begin + step, s.beams.size())};
    start_paths(s, prepared, block);
    for (std::size_t bounce = 0; bounce < prepared.camera.bounces; ++bounce) {
      cast_bounce_rays(s, prepared, block, exposure, bounce);
      cast_illuminator_rays(s, prepared, block, exposure);
      add_lit_ends(s, prepared, block, exposure);
    }
  }
  add_filtered_bounces(s, prepared, exposure);
}

}  // namespace glidar
