// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/tof: complex amplitudes of pixels.

#include <glidar/tof/tof_decode.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar::tof {

/// A complex amplitude.
struct Phasor {
  double re = 0.0;
  double im = 0.0;
};

inline double magnitude(const Phasor& z) {
  return std::sqrt(z.re * z.re + z.im * z.im);
}

/// Complex amplitudes, frequencies x pixels, with gains and without phase offsets; 0 where a raw
/// value of the frequency is saturated or the pixel is not illuminated.
struct PhasorImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t frequencies = 0;
  std::vector<Phasor> value = {};
  std::vector<std::uint8_t> is_saturated = {};  ///< per pixel: at some frequency
  std::vector<double> phase_change =
      {};  ///< per pixel: greatest of the frequencies; empty: no filter

  [[nodiscard]] std::size_t pixels() const { return width * height; }
};

/// Calls body(row) for all rows, on the threads of a pool if there is one.
template <class Body>
void for_each_row(ThreadPool* pool, std::size_t rows, const Body& body) {
  const auto run = [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) body(row);
  };
  if (pool == nullptr) return run(0, rows);
  pool->parallel_for(rows, 1, run);
}

PhasorImage make_phasors(const TofImages& images, const TofOptions& options,
                         const TofCalibration& calibration, ThreadPool* pool);

/// Smoothed as TofFilter states, except the pixels at the border of the image.
PhasorImage smooth(const PhasorImage& image, const TofFilter& filter, ThreadPool* pool);

}  // namespace glidar::tof
