// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulation.hpp>

#include <cstddef>
#include <cstdint>

namespace glidar {

/// An image that an imager takes, and its random numbers.
struct ImageExposure {
  const Imager& imager;
  Exposure exposure;
  double speckle_contrast = 0.0;
  Purpose purpose = Purpose::left_image;
  std::size_t number = 0;  ///< of the image among those of one purpose
};

/// Mean electrons of a pixel.
PixelLight light_of(const ElectronRates& rates, const Exposure& exposure, std::size_t pixel);

/// How a pixel of the image gets its grey level.
PixelReading read_pixel(const Simulation& s, const ElectronRates& rates, const ImageExposure& taken,
                        std::size_t pixel);

/// The image as the imager reports it, without a name.
RawImage read_image(const Simulation& s, const ElectronRates& rates, const ImageExposure& taken);

}  // namespace glidar
