// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth_camera/time_of_flight.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

// decode_tof() with what leads to its result.
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

/// A number for each frequency.
using PerFrequency = std::array<double, kMaxTofFrequencies>;

/// The frequencies and what follows from them.
struct Unwrapping {
  TofUnwrapping method = TofUnwrapping::best_fit;
  std::size_t frequencies = 0;
  std::size_t highest = 0;     ///< index of the highest frequency
  std::size_t periods = 1;     ///< of the highest frequency in the unambiguous range
  double unambiguous_m = 0.0;  ///< range after which all phases repeat
  PerFrequency per_m = {};     ///< periods per metre of range
  double per_m_sum = 0.0;      ///< sum of per_m
  double per_m_squares = 0.0;  ///< sum of per_m^2
};

/// One choice of whole periods.
struct Unwrapped {
  double range_m = 0.0;
  double misfit_rad = 0.0;  ///< distance of the phases from the line of all ranges
  PerFrequency turns = {};  ///< phases with their whole periods
};

/// Requires valid options.
Unwrapping make_unwrapping(const TofOptions& options);

/// The candidate in which the highest frequency has `period` whole periods: the other phases get
/// those that fit best. `turns` are phases in [0, 1).
Unwrapped unwrap_candidate(const Unwrapping& unwrapping, const PerFrequency& turns,
                           std::size_t period);

/// The range that the method selects.
Unwrapped unwrap(const Unwrapping& unwrapping, const PerFrequency& turns);

/// All that the tests of a pixel alone compare.
struct TofEvidence {
  PerFrequency amplitude = {};
  PerFrequency turns = {};  ///< phases in [0, 1)
  double amplitude_sum = 0.0;
  double min_amplitude = 0.0;
  double misfit_limit_rad = 0.0;
  Unwrapped unwrapped = {};
  double depth_m = 0.0;
  bool is_illuminated = true;
  bool is_saturated = false;
};

TofEvidence gather_evidence(const PhasorImage& phasors, const Unwrapping& unwrapping,
                            const TofOptions& options, const TofCalibration& calibration,
                            std::size_t pixel);

bool has_signal(const TofEvidence& pixel, const TofOptions& options);
bool has_fit(const TofEvidence& pixel);

/// The first of the tests before those of edges that the pixel fails.
TofStatus find_status(const TofEvidence& pixel, const TofOptions& options);

/// Depths and amplitudes of all pixels, which the edge test compares.
struct DecodedDepths {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<double> depth_m;  ///< 0: no depth; those beyond the limits are depths
  std::vector<double> amplitude_sum;
};

/// The 3x3 pixels around a pixel.
struct EdgeEvidence {
  bool is_border = false;  ///< at the border of the image, where there is no test
  double amplitude_deviation = 0.0;
  double near_step_m = 0.0;
  double far_step_m = 0.0;
  double phase_change = 0.0;
};

EdgeEvidence gather_edge_evidence(const DecodedDepths& image, const PhasorImage& phasors,
                                  const TofOptions& options, std::size_t pixel);

bool is_depth_edge(const EdgeEvidence& edge, const TofOptions& options);
bool is_phase_edge(const EdgeEvidence& edge, const TofOptions& options);

/// Everything from which decode_tof() finds its result.
struct Decoding {
  Unwrapping unwrapping;
  PhasorImage phasors;  ///< after the filter
  DecodedDepths depths;
  TofMeasurement measurement;
};

/// Throws Error as decode_tof() does.
Decoding decode(const TofImages& images, const TofOptions& options,
                const TofCalibration& calibration, ThreadPool* pool);

}  // namespace glidar::tof
