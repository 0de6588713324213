// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/image_reading.hpp>

namespace glidar {
namespace {

constexpr std::size_t kImagePixelsPerTask = 1024;

}  // namespace

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
  s.renderer.thread_pool().parallel_for(rates.projector.size(), kImagePixelsPerTask, read);
  return image;
}

}  // namespace glidar
