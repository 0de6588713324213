// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/infrared_image.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/sensor/lidar/lidar_equation.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/simulate/projector_occlusion.hpp>
#include <glidar/simulate/simulation.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <variant>

namespace glidar {
namespace {

/// Reflectance for light from all sides: that of the diffuse part of a surface.
double diffuse_reflectance(const HitSurface& surface) {
  if (const auto* phong = std::get_if<PhongLike>(surface.brdf)) {
    return (1.0 - phong->specular_fraction) * surface.reflectance;
  }
  if (const auto* glossy = std::get_if<Glossy>(surface.brdf)) {
    return glossy->diffuse_fraction * surface.reflectance;
  }
  return std::holds_alternative<RetroReflector>(*surface.brdf) ? 0.0 : surface.reflectance;
}

/// f for light from `to_light`, of length 1, that a surface sends to `to_camera`.
double reflection(const LitPoint& point, const Eigen::Vector3d& to_light,
                  const Eigen::Vector3d& to_camera) {
  const HitSurface& surface = point.surface;
  if (std::holds_alternative<Lambert>(*surface.brdf)) return surface.reflectance;
  const double cosine = point.normal.dot((to_light + to_camera).normalized());
  if (!(cosine > 0.0)) return 0.0;
  return backscatter(*surface.brdf, surface.reflectance, std::min(cosine, 1.0)) / cosine;
}

double projector_radiance(const InfraredLights& lights, const LitPoint& point,
                          const Eigen::Vector3d& to_camera) {
  const Eigen::Vector3d path = point.position_m - lights.projector_m;
  const double intensity = lights.projector(path);
  if (intensity == 0.0) return 0.0;
  const double square = path.squaredNorm();
  const Eigen::Vector3d to_light = -path / std::sqrt(square);
  const double cosine = point.normal.dot(to_light);
  if (!(cosine > 0.0)) return 0.0;
  return intensity / square * cosine * reflection(point, to_light, to_camera);
}

double sun_radiance(const InfraredLights& lights, const LitPoint& point,
                    const Eigen::Vector3d& to_camera) {
  const double cosine = point.normal.dot(lights.sun_direction);
  if (!(lights.sun_w_per_m2 > 0.0 && cosine > 0.0)) return 0.0;
  return lights.sun_w_per_m2 * cosine * reflection(point, lights.sun_direction, to_camera);
}

/// The camera whose rays are in the workspace's hits.
struct ShadowView {
  const PreparedImager& imager;
  const Pose& world_from_eye;
  std::uint32_t time_ns = 0;  ///< of the image, since the start of the frame
};

/// A source of light in the frame of that camera: a point, or the sun.
struct ShadowLight {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> sun_direction = {};  ///< towards it; empty: the light is a point
};

constexpr std::size_t kRaysPerTask = 4096;
constexpr double kSunReach = 1e4;    // metres from which rays of the sun come
constexpr double kRangeStep = 0.03;  // between neighbours, beyond which they are not one surface

/// What is known of a pixel's shadow.
enum class Shade : std::uint8_t { averted, lit, shadowed };

/// The image of rays as blocks of pixels.
struct RayGrid {
  std::size_t width;  ///< pixels
  std::size_t height;
  std::size_t n;  ///< rays along a side of a pixel

  explicit RayGrid(const PreparedImager& imager)
      : width(imager.size.width), height(imager.size.height), n(imager.setup.sub_rays) {}

  [[nodiscard]] std::size_t pixels() const { return width * height; }
  /// Ray k of a pixel, in rows.
  [[nodiscard]] std::size_t ray(std::size_t pixel, std::size_t k) const {
    return ray_of_pixel(width, n, pixel, k);
  }
  [[nodiscard]] std::size_t middle(std::size_t pixel) const { return ray(pixel, n * n / 2); }
};

/// Tests rays of a camera.
class ShadowTest {
 public:
  ShadowTest(const Simulation& s, const ShadowView& view, const ShadowLight& light,
             std::span<float> radiance)
      : s_(s), view_(view), light_(light), radiance_(radiance), grid_(view.imager) {}

  void run() {
    test_middles();
    find_edges();
    test_edges();
  }

 private:
  /// From the light to the surface of a ray.
  [[nodiscard]] Eigen::Vector3d path_to(std::size_t ray) const {
    if (light_.sun_direction) return -kSunReach * *light_.sun_direction;
    return point(ray) - light_.origin_m;
  }
  [[nodiscard]] Eigen::Vector3d point(std::size_t ray) const {
    return s_.workspace.infrared.hits.range_m[ray] * view_.imager.rays.directions[ray];
  }

  [[nodiscard]] bool faces_light(std::size_t ray) const {
    const Hits& hits = s_.workspace.infrared.hits;
    if (hits.instance[ray] == kInvalidId) return false;
    return hits.shading_normal[ray].cast<double>().dot(path_to(ray)) < 0.0;
  }

  /// Aims beam `to` from the light at the surface of a ray.
  void aim(std::size_t ray, std::size_t to) {
    Beams& beams = s_.workspace.infrared.shadow_rays;
    const Eigen::Vector3d path = path_to(ray);
    beams.origins_m[to] =
        light_.sun_direction ? Eigen::Vector3d(point(ray) - path) : light_.origin_m;
    beams.directions[to] = path.normalized();
  }

  [[nodiscard]] bool is_shadowed(std::size_t ray, std::size_t beam) const {
    const double range_m = s_.workspace.infrared.shadow_hits.range_m[beam];
    return range_m < (1.0 - kShadowEpsilon) * path_to(ray).norm();  // false for NaN
  }

  void resize_beams(std::size_t count) {
    Beams& beams = s_.workspace.infrared.shadow_rays;
    beams.rows = 1;
    beams.cols = static_cast<std::uint32_t>(count);
    beams.origins_m.resize(count);
    beams.directions.resize(count);
    beams.times_ns.assign(s_.is_moving ? count : 0, view_.time_ns);
  }

  void cast_beams() {
    CastRequest request = cast_request(s_, s_.workspace.infrared.shadow_rays, {});
    request.world_from_sensor = view_.world_from_eye;
    cast(s_, request, s_.workspace.infrared.shadow_hits);
  }

  template <class Body>
  void for_pixels(const Body& body) {
    s_.renderer.thread_pool().parallel_for(grid_.pixels(), kRaysPerTask,
                                           [&](std::size_t begin, std::size_t end) {
                                             for (std::size_t i = begin; i < end; ++i) body(i);
                                           });
  }

  /// One ray of each pixel. If it is in shadow so are the others, unless they are tested later.
  void test_middles() {
    std::vector<std::uint8_t>& shades = s_.workspace.infrared.shades;
    shades.resize(grid_.pixels());
    resize_beams(grid_.pixels());
    for_pixels([&](std::size_t pixel) {
      const std::size_t ray = grid_.middle(pixel);
      if (faces_light(ray)) return aim(ray, pixel);
      s_.workspace.infrared.shadow_rays.origins_m[pixel].setZero();
      s_.workspace.infrared.shadow_rays.directions[pixel].setConstant(kNaN);
    });
    cast_beams();
    for_pixels([&](std::size_t pixel) {
      const std::size_t ray = grid_.middle(pixel);
      Shade shade = Shade::averted;
      if (faces_light(ray)) shade = is_shadowed(ray, pixel) ? Shade::shadowed : Shade::lit;
      shades[pixel] = static_cast<std::uint8_t>(shade);
    });
  }

  /// Whether two pixels may not be on one surface with one kind of light.
  [[nodiscard]] bool differ(std::size_t a, std::size_t b) const {
    const InfraredWorkspace& memory = s_.workspace.infrared;
    if (memory.shades[a] != memory.shades[b]) return true;
    const std::size_t ray_a = grid_.middle(a);
    const std::size_t ray_b = grid_.middle(b);
    if (memory.hits.instance[ray_a] != memory.hits.instance[ray_b]) return true;
    const double range_a = memory.hits.range_m[ray_a];
    const double range_b = memory.hits.range_m[ray_b];
    return std::abs(range_a - range_b) > kRangeStep * range_a;
  }

  [[nodiscard]] bool is_edge(std::size_t pixel) const {
    const std::size_t row = pixel / grid_.width;
    const std::size_t column = pixel % grid_.width;
    for (std::size_t v = row > 0 ? row - 1 : 0; v <= std::min(row + 1, grid_.height - 1); ++v) {
      for (std::size_t u = column > 0 ? column - 1 : 0; u <= std::min(column + 1, grid_.width - 1);
           ++u) {
        if (differ(pixel, v * grid_.width + u)) return true;
      }
    }
    return false;
  }

  /// Flags the pixels of which all rays are to be tested; those of other pixels in shadow become 0.
  void find_edges() {
    std::vector<std::uint8_t>& flags = s_.workspace.infrared.edges;
    flags.resize(grid_.pixels());
    for_pixels([&](std::size_t pixel) { flags[pixel] = is_edge(pixel) ? 1 : 0; });
    for_pixels([&](std::size_t pixel) {
      const bool is_dark =
          s_.workspace.infrared.shades[pixel] == static_cast<std::uint8_t>(Shade::shadowed);
      if (flags[pixel] == 0 && is_dark) set_dark(pixel);
    });
  }

  void set_dark(std::size_t pixel) {
    for (std::size_t k = 0; k < grid_.n * grid_.n; ++k) radiance_[grid_.ray(pixel, k)] = 0.0F;
  }

  /// Tests all rays of the flagged pixels that have light.
  void test_edges() {
    const std::vector<std::uint8_t>& flags = s_.workspace.infrared.edges;
    std::vector<std::size_t>& rays = s_.workspace.infrared.tested_rays;
    rays.clear();
    for (std::size_t pixel = 0; pixel < flags.size(); ++pixel) {
      if (flags[pixel] == 0) continue;
      for (std::size_t k = 0; k < grid_.n * grid_.n; ++k) {
        if (radiance_[grid_.ray(pixel, k)] > 0.0F) rays.push_back(grid_.ray(pixel, k));
      }
    }
    if (rays.empty()) return;
    resize_beams(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) aim(rays[i], i);
    cast_beams();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (is_shadowed(rays[i], i)) radiance_[rays[i]] = 0.0F;
    }
  }

  const Simulation& s_;
  const ShadowView& view_;
  const ShadowLight& light_;
  std::span<float> radiance_;
  RayGrid grid_;
};

/// Sets the radiance of rays to 0 whose surface does not see the light. One ray of each pixel is
/// tested; all are where neighbouring pixels differ, in light or shadow, in the object, or by more
/// than 3 % in range. Shadows of details that are narrower than that miss rays.
void remove_shadows(const Simulation& s, const ShadowView& view, const ShadowLight& light,
                    std::span<float> radiance) {
  ShadowTest(s, view, light, radiance).run();
}

constexpr HitColumnMask kShadedColumns = {.shading_normal = true, .diffuse = true};
constexpr std::size_t kPixelsPerTask = 4096;

/// The sensor's pose when the image is taken.
Pose sensor_pose(const Simulation& s, std::uint32_t time_ns) {
  if (!s.is_moving) return s.frame.world_from_sensor;
  return pose_at(s.motion.world_from_sensor, s.frame.stamp_ns + time_ns);
}

InfraredLights lights_of(const Simulation& s, const InfraredView& view) {
  const AmbientLight& light = view.imager.setup.illumination;
  const Eigen::Matrix3d rotation = sensor_pose(s, view.time_ns).linear();
  return {.projector = view.projector,
          .projector_m = view.projector_m - view.eye_m,
          .sun_direction = (rotation.transpose() * light.sun_direction).normalized(),
          .sun_w_per_m2 = light.sun_w_per_m2,
          .ambient_w_per_m2 = light.ambient_w_per_m2};
}

/// Shades a tile of rays without shadows.
void shade(const Simulation& s, const PreparedImager& imager, const InfraredLights& lights,
           BeamRange tile) {
  InfraredWorkspace& memory = s.workspace.infrared;
  const Hits& hits = memory.hits;
  SurfaceReflectance surfaces(s.scene, imager.wavelength_m);
  const auto background = static_cast<float>(background_radiance(lights));
  for (std::size_t i = tile.begin; i < tile.end; ++i) {
    memory.projector[i] = 0.0F;
    memory.ambient[i] = background;
    if (!memory.sun.empty()) memory.sun[i] = 0.0F;
    if (hits.instance[i] == kInvalidId) continue;
    const InfraredRadiance radiance =
        infrared_radiance(lights, {.position_m = hits.range_m[i] * imager.rays.directions[i],
                                   .normal = hits.shading_normal[i].cast<double>(),
                                   .surface = surfaces.at(hits, i)});
    memory.projector[i] = static_cast<float>(radiance.projector);
    memory.ambient[i] = static_cast<float>(radiance.ambient);
    if (!memory.sun.empty()) memory.sun[i] = static_cast<float>(radiance.sun);
  }
}

/// The rays of an image; where something moves, at its time.
const Beams& timed_rays(const Simulation& s, const InfraredView& view) {
  if (!s.is_moving) return view.imager.rays;
  Beams& rays = s.workspace.infrared.timed_rays;
  if (rays.size() != view.imager.rays.size()) rays = view.imager.rays;
  rays.times_ns.assign(rays.size(), view.time_ns);
  return rays;
}

void cast_rays(const Simulation& s, const InfraredView& view, const Pose& world_from_eye,
               const InfraredLights& lights) {
  InfraredWorkspace& memory = s.workspace.infrared;
  const std::size_t count = view.imager.rays.size();
  memory.projector.resize(count);
  memory.ambient.resize(count);
  memory.sun.resize(lights.sun_w_per_m2 > 0.0 ? count : 0);
  const auto shade_tile = [&](BeamRange tile) { shade(s, view.imager, lights, tile); };
  CastRequest request = cast_request(s, timed_rays(s, view), kShadedColumns);
  request.world_from_sensor = world_from_eye;
  request.on_tile_done = FunctionRef<void(BeamRange)>(shade_tile);
  cast(s, request, memory.hits);
}

/// Adds the sun's light to that from all sides.
void add_sun(InfraredWorkspace& memory, ThreadPool& threads) {
  threads.parallel_for(memory.sun.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) memory.ambient[i] += memory.sun[i];
  });
}

/// Radiance towards the camera of the surface that each ray meets.
void find_radiance(const Simulation& s, const InfraredView& view) {
  InfraredWorkspace& memory = s.workspace.infrared;
  const Pose world_from_eye = s.frame.world_from_sensor * Eigen::Translation3d(view.eye_m);
  const InfraredLights lights = lights_of(s, view);
  cast_rays(s, view, world_from_eye, lights);
  const ShadowView shadow_view{view.imager, world_from_eye, view.time_ns};
  remove_shadows(s, shadow_view, {.origin_m = lights.projector_m}, memory.projector);
  if (memory.sun.empty()) return;
  remove_shadows(s, shadow_view, {.sun_direction = lights.sun_direction}, memory.sun);
  add_sun(memory, s.renderer.thread_pool());
}

}  // namespace

InfraredRadiance infrared_radiance(const InfraredLights& lights, const LitPoint& point) {
  const Eigen::Vector3d to_camera = -point.position_m.normalized();
  const double share = point.surface.opacity * std::numbers::inv_pi;
  return {.projector = share * projector_radiance(lights, point, to_camera),
          .sun = share * sun_radiance(lights, point, to_camera),
          .ambient = share * lights.ambient_w_per_m2 * diffuse_reflectance(point.surface)};
}

double background_radiance(const InfraredLights& lights) {
  return lights.ambient_w_per_m2 * std::numbers::inv_pi;
}

void find_electron_rates(const Simulation& s, const PreparedImager& imager,
                         std::span<const float> radiance, std::vector<float>& per_s) {
  ThreadPool& threads = s.renderer.thread_pool();
  average_rays(radiance, imager.setup.sub_rays, imager.weights, imager.size, threads, per_s);
  const auto scale = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double z = s.beams.directions[i].z();
      const double cosine = z > 0.0 ? z : 0.0;  // not for NaN
      const double rate = imager.electron_rate * (cosine * cosine) * (cosine * cosine);
      per_s[i] = static_cast<float>(rate * per_s[i]);
    }
  };
  threads.parallel_for(per_s.size(), kPixelsPerTask, scale);
}

void render_infrared(const Simulation& s, const InfraredView& view, ElectronRates& rates) {
  InfraredWorkspace& memory = s.workspace.infrared;
  find_radiance(s, view);
  rates.width = view.imager.size.width;
  rates.height = view.imager.size.height;
  find_electron_rates(s, view.imager, memory.projector, rates.projector);
  find_electron_rates(s, view.imager, memory.ambient, rates.ambient);
}

PixelLight light_of(const ElectronRates& rates, const Exposure& exposure, std::size_t pixel) {
  return {exposure.time_s * double{rates.projector[pixel]},
          exposure.time_s * double{rates.ambient[pixel]}};
}

PixelReading read_pixel(const Simulation& s, const ElectronRates& rates, const ImageExposure& taken,
                        std::size_t pixel) {
  const std::size_t entry = taken.number * rates.projector.size() + pixel;
  return read_pixel(taken.imager, levels_per_electron(taken.imager, taken.exposure),
                    taken.speckle_contrast, light_of(rates, taken.exposure, pixel),
                    rng_key(s.frame, taken.purpose, entry));
}

RawImage read_image(const Simulation& s, const ElectronRates& rates, const ImageExposure& taken) {
  RawImage image;
  image.grey = {.width = rates.width,
                .height = rates.height,
                .max_level = (1U << taken.imager.bits) - 1U,
                .level = std::vector<std::uint16_t>(rates.projector.size())};
  image.electrons.resize(rates.projector.size());
  const auto read = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const PixelLight light = light_of(rates, taken.exposure, i);
      image.electrons[i] = static_cast<float>(light.projector_e + light.ambient_e);
      image.grey.level[i] = read_pixel(s, rates, taken, i).level;
    }
  };
  constexpr std::size_t kReadingsPerTask = 1024;
  s.renderer.thread_pool().parallel_for(rates.projector.size(), kReadingsPerTask, read);
  return image;
}

}  // namespace glidar
