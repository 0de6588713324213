// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/pattern_images.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/simulate/image_reading.hpp>
#include <glidar/simulate/infrared_image.hpp>

#include <cmath>
#include <string>

namespace glidar {
namespace {

constexpr std::size_t kPatternRaysPerTask = 4096;

template <class Body>
void for_rays(const Simulation& s, const Body& body) {
  s.renderer.thread_pool().parallel_for(s.workspace.infrared.projector.size(), kPatternRaysPerTask,
                                        [&](std::size_t begin, std::size_t end) {
                                          for (std::size_t i = begin; i < end; ++i) body(i);
                                        });
}

/// Rates of all pixels in the projector's greatest light, and the coordinate that lights each ray.
void light_scene(const Simulation& s, const PreparedStructuredLight& prepared,
                 std::uint32_t time_ns) {
  const auto white = [&](const Eigen::Vector3d& path) {
    return projector_pixel(prepared, path) ? prepared.white_w_per_sr : 0.0;
  };
  InfraredWorkspace& memory = s.workspace.infrared;
  render_infrared(s,
                  {.imager = prepared.imager,
                   .projector = ProjectorIntensity(white),
                   .projector_m = prepared.projector_m,
                   .time_ns = time_ns},
                  memory.left);
  memory.projector_px.resize(memory.projector.size());
  const int axis = axis_index(prepared.camera.patterns);
  for_rays(s, [&](std::size_t ray) {
    memory.projector_px[ray] = kNaNf;
    if (!(memory.projector[ray] > 0.0F)) return;
    const Eigen::Vector3d point = memory.hits.range_m[ray] * prepared.imager.rays.directions[ray];
    const auto pixel = projector_pixel(prepared, point - prepared.projector_m);
    if (pixel) memory.projector_px[ray] = static_cast<float>((*pixel)[axis]);
  });
}

/// The pixels that the projector lights; all of them where there are none.
ElectronRates lit_pixels(const ElectronRates& rates) {
  ElectronRates lit;
  lit.height = 1;
  for (std::size_t i = 0; i < rates.projector.size(); ++i) {
    if (!(rates.projector[i] > 0.0F)) continue;
    lit.projector.push_back(rates.projector[i]);
    lit.ambient.push_back(rates.ambient[i]);
  }
  lit.width = static_cast<std::uint32_t>(lit.projector.size());
  return lit.width > 0 ? lit : rates;
}

/// Replaces the rates of the projector's light by those of a pattern.
void find_pattern_rates(const Simulation& s, const PreparedStructuredLight& prepared,
                        std::size_t number) {
  InfraredWorkspace& memory = s.workspace.infrared;
  const std::vector<float>& line = prepared.lines[number];
  memory.pattern_radiance.resize(memory.projector.size());
  for_rays(s, [&](std::size_t ray) {
    const float place_px = memory.projector_px[ray];
    const float share = std::isnan(place_px) ? 0.0F : light_at(line, place_px);
    memory.pattern_radiance[ray] = share * memory.projector[ray];
  });
  find_electron_rates(s, prepared.imager, memory.pattern_radiance, memory.left.projector);
}

/// "pattern_07".
std::string image_name(std::size_t number) {
  return std::string("pattern_") + (number < 10 ? "0" : "") + std::to_string(number);
}

}  // namespace

std::vector<RawImage> take_pattern_images(const Simulation& s,
                                          const PreparedStructuredLight& prepared) {
  const StructuredLightCamera& camera = prepared.camera;
  InfraredWorkspace& memory = s.workspace.infrared;
  Simulation timed = s;
  timed.is_moving = camera.image_interval_s > 0.0 && moves(s.motion);
  std::vector<RawImage> images;
  for (std::size_t i = 0; i < prepared.lines.size(); ++i) {
    if (i == 0 || timed.is_moving) {
      light_scene(timed, prepared, exposure_time_ns(i, camera.image_interval_s));
    }
    if (i == 0) memory.exposure = find_exposure(camera.imager, lit_pixels(memory.left));
    find_pattern_rates(timed, prepared, i);
    images.push_back(read_image(timed, memory.left,
                                {.imager = camera.imager,
                                 .exposure = memory.exposure,
                                 .speckle_contrast = camera.light.speckle_contrast,
                                 .purpose = Purpose::pattern_image,
                                 .number = i}));
    images.back().name = image_name(i);
  }
  return images;
}

}  // namespace glidar
