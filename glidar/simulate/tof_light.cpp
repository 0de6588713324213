// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/tof_light.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/lidar/surface_reflectance.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/simulate/projector_occlusion.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace glidar {
namespace {

/// The surface that a pixel's beam hits.
struct PixelSurface {
  Eigen::Vector3d point_m;
  Eigen::Vector3d normal;
  double range_m;
};

PixelSurface surface_of(const Simulation& s, std::size_t pixel) {
  const Hits& truth = s.frame.ground_truth;
  const double range_m = truth.range_m[pixel];
  return {range_m * s.beams.directions[pixel], truth.normal[pixel].cast<double>(), range_m};
}

/// Whether both pixels see one surface without much curvature. False for misses.
bool is_same_surface(const PixelSurface& a, const PixelSurface& b) {
  constexpr double kMinCosine = 0.966;        // 15 degrees
  constexpr double kMaxPlaneDistance = 0.01;  // of the range
  return a.normal.dot(b.normal) >= kMinCosine &&
         std::abs(a.normal.dot(b.point_m - a.point_m)) <= kMaxPlaneDistance * a.range_m;
}

/// Rows and columns around a pixel, within the image.
struct Square {
  std::size_t first_row;
  std::size_t end_row;
  std::size_t first_column;
  std::size_t end_column;
};

Square square_around(const Simulation& s, std::size_t pixel, std::size_t radius) {
  const std::size_t row = pixel / s.beams.cols;
  const std::size_t column = pixel % s.beams.cols;
  return {row - std::min(row, radius), std::min(row + radius + 1, std::size_t{s.beams.rows}),
          column - std::min(column, radius),
          std::min(column + radius + 1, std::size_t{s.beams.cols})};
}

/// Adds the light of the exposure's steps, multiplied by `scale`.
void add_scaled(const TofExposure& exposure, double scale, const TofLight* from, TofLight* to) {
  for (std::size_t i = exposure.first; i < exposure.end; ++i) {
    to[i].signal += scale * from[i].signal;
    to[i].correlated += scale * from[i].correlated;
  }
}

/// Adds the mean of the light over bounces to a pixel; `sum` is memory for it.
void add_bounces_to(const Simulation& s, const PreparedTof& prepared, const TofExposure& exposure,
                    std::size_t pixel, std::vector<TofLight>& sum) {
  TofWorkspace& memory = s.workspace.tof;
  const std::size_t steps = step_count(prepared);
  const PixelSurface own = surface_of(s, pixel);
  const Square square = square_around(s, pixel, prepared.camera.bounce_filter_px);
  sum.assign(steps, {});
  double reflectance = 0.0;
  for (std::size_t row = square.first_row; row < square.end_row; ++row) {
    for (std::size_t column = square.first_column; column < square.end_column; ++column) {
      const std::size_t other = row * s.beams.cols + column;
      if (other != pixel && !is_same_surface(own, surface_of(s, other))) continue;
      reflectance += memory.reflectance[other];
      add_scaled(exposure, 1.0, &memory.bounced_light[other * steps], sum.data());
    }
  }
  if (!(reflectance > 0.0)) return;
  const double scale = memory.reflectance[pixel] / reflectance;
  add_scaled(exposure, scale, sum.data(), &memory.light[pixel * steps]);
  if (exposure.first == 0) memory.bounced[pixel] = static_cast<float>(scale * sum[0].signal);
}

/// Adds the light over bounces of an exposure to the pixels, averaged over those pixels of a square
/// of bounce_filter_px around each that see the same surface: of similar normals, and near each
/// other's plane. Light on a surface changes slowly, so this reduces the noise of the paths; the
/// sum over these pixels is divided by the sum of their reflectances and multiplied by that of the
/// pixel. Needs range_m and normal in frame.ground_truth.
void add_filtered_bounces(const Simulation& s, const PreparedTof& prepared,
                          const TofExposure& exposure) {
  s.renderer.thread_pool().parallel_for(s.beams.rows, 1, [&](std::size_t begin, std::size_t end) {
    std::vector<TofLight> sum;
    for (std::size_t i = begin * s.beams.cols; i < end * s.beams.cols; ++i) {
      add_bounces_to(s, prepared, exposure, i, sum);
    }
  });
}

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

/// Adds the light of the illuminator that reaches the pixels' surfaces over diffuse bounces. Each
/// pixel has bounce_rays paths: from a surface that the pixel sees they leave in directions with
/// the density cosine / pi; what they meet, and an illuminator ray shows to be lit, sends back A
/// rho_1 rho_2 cosine / R^2, divided by the number of paths, with the phase of the whole way. Paths
/// continue from there for further bounces. Surfaces reflect bounced light as diffuse ones of their
/// reflectance. Needs the hits of the rays of all pixels.
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

constexpr HitColumnMask kTofColumns = {.shading_normal = true, .shading = true, .diffuse = true};

/// Casts the rays of all pixels at the time of an exposure.
void cast_rays(const Simulation& s, const PreparedTof& prepared, const TofExposure& exposure) {
  TofWorkspace& memory = s.workspace.tof;
  if (!s.is_moving) {
    return cast(s, cast_request(s, prepared.rays, kTofColumns), memory.hits);
  }
  if (memory.rays.size() != prepared.rays.size()) memory.rays = prepared.rays;
  memory.rays.times_ns.assign(memory.rays.size(), exposure.time_ns);
  cast(s, cast_request(s, memory.rays, kTofColumns), memory.hits);
}

/// Adds the light of one ray to its pixel; returns the share of light that the surface reflects.
double add_ray(const PreparedTof& prepared, const TofExposure& exposure,
               SurfaceReflectance& surfaces, const Hits& hits, std::size_t ray,
               std::span<TofLight> of_steps) {
  if (hits.instance[ray] == kInvalidId) return 0.0;
  const TofCamera& camera = prepared.camera;
  const HitSurface surface = surfaces.at(hits, ray);
  const double range_m = hits.range_m[ray];
  const double cosine = std::clamp(double{hits.cos_shading[ray]}, 0.0, 1.0);
  const double share = double{surface.opacity} / (camera.sub_rays * camera.sub_rays);
  const double returned = backscatter(*surface.brdf, surface.reflectance, cosine);
  const double reflected = share * std::min(1.0, surface.reflectance);
  const TofLight light{.signal = share * camera.signal_electrons * returned / (range_m * range_m),
                       .background = camera.ambient_electrons * reflected};
  add_light(prepared.steps, exposure, light, range_m, of_steps);
  return reflected;
}

/// Adds the light of a pixel's sub-rays to its steps. Returns the reflectance seen, from 0 to 1.
double add_sub_rays(const Simulation& s, const PreparedTof& prepared, const TofExposure& exposure,
                    SurfaceReflectance& surfaces, std::size_t pixel) {
  TofWorkspace& memory = s.workspace.tof;
  const std::size_t n = prepared.camera.sub_rays;
  const std::size_t steps = step_count(prepared);
  const std::span<TofLight> of_steps(&memory.light[pixel * steps], steps);
  double reflectance = 0.0;
  for (std::size_t i = 0; i < n * n; ++i) {
    const std::size_t ray = ray_of_pixel(s.beams.cols, n, pixel, i);
    reflectance += add_ray(prepared, exposure, surfaces, memory.hits, ray, of_steps);
  }
  return reflectance;
}

void add_direct_light(const Simulation& s, const PreparedTof& prepared,
                      const TofExposure& exposure) {
  const std::size_t columns = s.beams.cols;
  const auto add_rows = [&](std::size_t begin, std::size_t end) {
    SurfaceReflectance surfaces(s.scene, prepared.wavelength_m);
    for (std::size_t pixel = begin * columns; pixel < end * columns; ++pixel) {
      s.workspace.tof.reflectance[pixel] = add_sub_rays(s, prepared, exposure, surfaces, pixel);
    }
  };
  s.renderer.thread_pool().parallel_for(s.beams.rows, 1, add_rows);
}

/// One for all steps where nothing moves, otherwise one for each.
std::vector<TofExposure> list_exposures(const Simulation& s, const PreparedTof& prepared) {
  const std::size_t steps = step_count(prepared);
  if (!s.is_moving) return {{0, steps, 0}};
  std::vector<TofExposure> exposures;
  for (std::size_t i = 0; i < steps; ++i) {
    exposures.push_back({i, i + 1, exposure_time_ns(i, prepared.camera.step_interval_s)});
  }
  return exposures;
}

}  // namespace

void add_light(const TofSteps& steps, const TofExposure& exposure, const TofLight& light,
               double range_m, std::span<TofLight> of_steps) {
  for (std::size_t i = exposure.first; i < exposure.end; ++i) {
    of_steps[i].background += light.background;
  }
  if (exposure.end - exposure.first == of_steps.size()) {
    return add_light(steps, range_m, light.signal, of_steps);
  }
  for (std::size_t i = exposure.first; i < exposure.end; ++i) {
    add_light(steps, range_m, light.signal, i, of_steps[i]);
  }
}

void find_tof_light(const Simulation& s, const PreparedTof& prepared) {
  TofWorkspace& memory = s.workspace.tof;
  memory.light.assign(s.beams.size() * step_count(prepared),
                      {.background = prepared.camera.dark_electrons});
  memory.reflectance.resize(s.beams.size());
  memory.bounced.assign(s.beams.size(), 0.0F);
  Simulation timed = s;
  timed.is_moving = prepared.camera.step_interval_s > 0.0 && moves(s.motion);
  for (const TofExposure& exposure : list_exposures(timed, prepared)) {
    cast_rays(timed, prepared, exposure);
    add_direct_light(timed, prepared, exposure);
    if (prepared.camera.bounces > 0) add_bounces(timed, prepared, exposure);
  }
}

}  // namespace glidar
