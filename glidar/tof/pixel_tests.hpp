// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/tof: what is known about a pixel, and its tests.

#include <glidar/tof/phase_unwrapping.hpp>
#include <glidar/tof/phasor_image.hpp>

#include <cstddef>

namespace glidar::tof {

/// All that the tests of a pixel alone compare.
struct PixelEvidence {
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

PixelEvidence gather_evidence(const PhasorImage& phasors, const Unwrapping& unwrapping,
                              const TofOptions& options, const TofCalibration& calibration,
                              std::size_t pixel);

bool has_signal(const PixelEvidence& pixel, const TofOptions& options);
bool has_fit(const PixelEvidence& pixel);

/// The first of the tests before those of edges that the pixel fails.
TofStatus find_status(const PixelEvidence& pixel, const TofOptions& options);

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

}  // namespace glidar::tof
