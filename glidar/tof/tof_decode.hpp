// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/report.hpp>
#include <glidar/core/tof_images.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/tof/tof_options.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// Why a pixel has no range: the first test that it fails, in this order.
enum class TofStatus : std::uint8_t {
  valid,
  not_illuminated,  ///< outside the part of the image that the illuminator lights
  saturated,        ///< a raw value is saturated
  low_signal,       ///< the amplitude is too small, of one frequency or of all
  ambiguous,        ///< the phases fit no range: light of several paths, or noise
  too_near,         ///< depth below the limit
  too_far,          ///< depth above the limit
  edge              ///< neighbours have other phases or depths: light of two surfaces mixes
};
inline constexpr std::size_t kTofStatusCount = 8;

/// "valid", "not_illuminated", "saturated", "low_signal", "ambiguous", "too_near", "too_far" or
/// "edge".
const char* to_string(TofStatus status);

/// What is known about each pixel; an empty span has the value in brackets for all pixels.
struct TofCalibration {
  std::span<const float> depth_per_range = {};        ///< cosine to the boresight (1)
  std::span<const float> phase_offset_rad = {};       ///< frequencies x pixels, subtracted (0)
  std::span<const std::uint8_t> is_illuminated = {};  ///< 0: no light of the illuminator (1)
};

/// The result of decode_tof(), for each pixel, row by row from the top.
struct TofMeasurement {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t frequencies = 0;
  std::vector<double> range_m;    ///< along the pixel's beam; NaN unless the status is valid
  std::vector<TofStatus> status;  ///< as many
  std::vector<float> amplitude;   ///< frequencies x pixels, with amplitude_gain, after the filter
  std::vector<float> phase_rad;   ///< frequencies x pixels, in [0, 2 pi), after the filter
  std::vector<float> misfit_rad;  ///< of the phases; NaN where the signal is low or saturated
};

/// How decode_tof() is executed.
struct TofRun {
  ThreadPool* pool = nullptr;  ///< null: one thread
};

/// Ranges from the raw images of a continuous-wave camera. For each frequency the complex amplitude
/// is (2 / N) sum D_k exp(j 2 pi k / N); its argument is the phase 4 pi f R / c (Lange and Seitz,
/// IEEE J. Quantum Electronics 37 (2001)). Then filter, unwrapping and tests as TofOptions states.
/// The result is the same for every number of threads. Throws Error when the sizes of images,
/// options and calibration differ or an option is not allowed.
TofMeasurement decode_tof(const TofImages& images, const TofOptions& options,
                          const TofCalibration& calibration = {}, const TofRun& run = {});

}  // namespace glidar
