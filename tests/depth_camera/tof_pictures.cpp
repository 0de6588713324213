// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <depth_camera/tof_pictures.hpp>

#include <utility>

namespace glidar::testing {
namespace {

template <class Expose>
TofImages expose_all(const TofCamera& camera, std::uint32_t width, std::uint32_t height,
                     const TofScene& scene, const Expose& expose_step) {
  const TofSteps steps = make_tof_steps(camera);
  const auto frequencies = static_cast<std::uint32_t>(steps.frequencies);
  TofImages images{width, height, frequencies, camera.decoder.taps};
  images.level.resize(pixel_count(images) * frequencies * images.taps);
  std::vector<TofLight> light(std::size_t{frequencies} * images.taps);
  for (std::size_t i = 0; i < pixel_count(images); ++i) {
    const TofTarget target =
        scene(static_cast<std::uint32_t>(i % width), static_cast<std::uint32_t>(i / width));
    light.assign(light.size(), TofLight{.background = target.background});
    add_light(steps, target.range_m, target.electrons, light);
    for (std::size_t step = 0; step < light.size(); ++step) {
      images.level[step * pixel_count(images) + i] =
          expose_step(step / images.taps, light[step], i, step);
    }
  }
  return images;
}

}  // namespace

TofCamera plain_camera(std::vector<double> frequencies_hz, std::uint32_t taps) {
  TofCamera camera;
  camera.signal_electrons = 1.0;
  camera.decoder.frequencies_hz = std::move(frequencies_hz);
  camera.decoder.taps = taps;
  return camera;
}

TofImages expose_scene(const TofCamera& camera, std::uint32_t width, std::uint32_t height,
                       const TofScene& scene) {
  return expose_all(camera, width, height, scene,
                    [&](std::size_t frequency, const TofLight& light, std::size_t, std::size_t) {
                      return expose_without_noise(camera, frequency, light);
                    });
}

TofImages expose_noisy_scene(const TofCamera& camera, std::uint32_t width, std::uint32_t height,
                             const TofScene& scene, std::uint64_t seed) {
  return expose_all(
      camera, width, height, scene,
      [&](std::size_t frequency, const TofLight& light, std::size_t pixel, std::size_t step) {
        return expose(camera, frequency, light,
                      {.seed = seed,
                       .beam = static_cast<std::uint32_t>(pixel),
                       .block = static_cast<std::uint32_t>(step)});
      });
}

}  // namespace glidar::testing
