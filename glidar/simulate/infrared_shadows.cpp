// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/infrared_shadows.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/sensor/optics/sub_pixels.hpp>
#include <glidar/simulate/projector_occlusion.hpp>

#include <algorithm>

namespace glidar {
namespace {

constexpr std::size_t kRaysPerTask = 4096;
constexpr std::size_t kRowsPerTask = 4;
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

}  // namespace

void remove_shadows(const Simulation& s, const ShadowView& view, const ShadowLight& light,
                    std::span<float> radiance) {
  ShadowTest(s, view, light, radiance).run();
}

}  // namespace glidar
